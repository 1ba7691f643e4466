#include "bench/suite/reduce.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/line.hpp"

namespace jvari::bench::suite {

namespace {
constexpr double swing = 0.2;  // of the largest value, that a turn falls by

double itself(double y) {
    return y;
}

Reduced the_one_row(const Series& s) {
    if (s.size() == 1) return {s.begin()->second};
    return {.why = fmt::format("{} rows carry these values, expected one; say more in `where`, or another `take`", s.size())};
}

double mean_of(const Series& s, double (*of)(double)) {
    double sum = 0;
    for (const auto& [x, y] : s) sum += of(y);
    return sum / static_cast<double>(s.size());
}

double largest_of(const Series& s, double (*of)(double)) {
    double largest = -HUGE_VAL;
    for (const auto& [x, y] : s) largest = std::max(largest, of(y));
    return largest;
}

Reduced slope_of(const Series& s) {
    std::vector<double> x, y;
    for (const auto& [at, value] : s) x.push_back(at), y.push_back(value);
    const Line line = fitted_line(x, y);
    if (std::isfinite(line.slope) && std::isfinite(line.half_width)) return {line.slope, line.half_width};
    return {.why = fmt::format("{} rows, and a slope with its interval takes three", s.size())};
}

Reduced turns_of(const Series& s) {  // how often it turns down by a fifth of its largest value
    const double least_fall = swing * largest_of(s, itself);
    double top = -HUGE_VAL, bottom = HUGE_VAL;
    int turns = 0;
    bool rising = true;
    for (const auto& [x, y] : s) {
        if (rising) top = std::max(top, y);
        else bottom = std::min(bottom, y);
        if (rising && y < top - least_fall) rising = false, bottom = y, ++turns;
        else if (!rising && y > bottom + least_fall) rising = true, top = y;
    }
    return {static_cast<double>(turns)};
}

// Relative L2 distance from the nearest two straight lines that begin and end at 0: of a shape, 0 for Helmholtz motion. The two lines meet
// over one of the points, wherever they fit best.
Reduced off_two_lines(const Series& s) {
    const double end = s.rbegin()->first;
    double least = HUGE_VAL, power = 0;
    for (const auto& [x, y] : s) power += y * y;
    for (const auto& [corner, unused] : s) {
        if (corner <= 0 || corner >= end) continue;
        double wy = 0, ww = 0;
        for (const auto& [x, y] : s) {
            const double w = x <= corner ? x / corner : (end - x) / (end - corner);
            wy += w * y, ww += w * w;
        }
        least = std::min(least, std::sqrt(std::max(0.0, power - wy * wy / ww) / power));
    }
    return {least};
}
}  // namespace

std::span<const Take> takes() {
    using S = const Series&;
    static constexpr Take all[] = {
        {"value", the_one_row},
        {"mean", [](S s) { return Reduced{mean_of(s, itself)}; }},
        {"largest", [](S s) { return Reduced{largest_of(s, itself)}; }},
        {"least", [](S s) { return Reduced{-largest_of(s, [](double y) { return -y; })}; }},
        {"size", [](S s) { return Reduced{largest_of(s, [](double y) { return std::abs(y); })}; }},  // the largest magnitude
        {"rms", [](S s) { return Reduced{std::sqrt(mean_of(s, [](double y) { return y * y; }))}; }},
        {"slope", slope_of},  // of the fitted line over `along`
        {"share_above_0", [](S s) { return Reduced{mean_of(s, [](double y) { return y > 0 ? 1.0 : 0.0; })}; }},  // part of the rows
        {"turns", turns_of},
        {"off_two_lines", off_two_lines},
    };
    return all;
}

}  // namespace jvari::bench::suite
