#include "bench/trim/judge.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/errors.hpp"
#include "scenes/start.hpp"

namespace jvari::bench::trim {

namespace {
constexpr double most_without_unit = 0.5;  // a larger tolerance is more likely meant in per cent

std::string name_of(const std::string& column) {
    for (const auto& [of, name] :
         {std::pair{"stft_db", "stft"}, {"centroid_relative", "centroid"}, {"decay_db", "decay"}})
        if (column == of) return name;
    return column.starts_with("error_") ? column.substr(6) : column;
}
}  // namespace

std::vector<Target> targets() {
    std::vector<Target> all;
    for (std::size_t k = 0; k < study::measures().size(); ++k)
        if (const study::Measure& m = study::measures()[k]; m.less_is_better)
            all.push_back({k, 0, name_of(m.column), m.title.substr(0, m.title.find(" [")),
                           m.unit == "1" ? "%" : m.unit});
    return all;
}

Target target_of(const std::string& name, const std::string& within) {
    const std::vector<Target> all = targets();
    const auto found = std::ranges::find(all, name, &Target::name);
    if (found == all.end()) {
        std::vector<std::string> names;
        for (const Target& t : all) names.push_back(t.name);
        throw store::UsageError("--of " + store::unknown("measure", name, names));
    }
    Target target = *found;
    // of the number; npos + 1: there is none
    const auto end = within.find_last_of("0123456789.") + 1;
    const double x = store::number_of(within.substr(0, end));
    std::string unit = within.substr(end);
    unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
    const bool relative = target.unit == "%";
    if (const auto other = std::ranges::find(all, unit, &Target::unit);
        unit != target.unit && other != all.end())
        throw store::UsageError(fmt::format("--within {}: that is a tolerance of {}: add --of {}",
                                            within, other->name, other->name));
    if (!std::isfinite(x) || !(x > 0) || (!unit.empty() && unit != target.unit))
        throw store::UsageError(fmt::format("--within {}: expected a tolerance of {}, as 1{}",
                                            within, name, target.unit));
    if (relative && unit.empty() && x > most_without_unit)
        throw store::UsageError(fmt::format(
            "--within {}: without a unit this is {:.4g} %; say {}%, or {:.4g}% where that is meant",
            within, 100 * x, within, 100 * x));
    target.most = unit == "%" ? x / 100 : x;
    return target;
}

std::string Target::text(double error, const char* unknown) const {
    if (std::isnan(error)) return unknown;
    return fmt::format("{:.2g} {}", unit == "%" ? 100 * error : error, unit);
}

namespace {
constexpr double sizes[starts] = {1, 0.8, 0.7, 0.9, 0.6};
constexpr double places[starts] = {0, 0.88, 0.31, 0.42, 0.67};  // of the string's length
// of the string's length: what rounds the sharpest corner, which has modes without end otherwise
constexpr double plectrum = 0.01;
constexpr double shortest[starts] = {1, 0.5, 0.7, 0.9, 0.6};  // of the time that a pluck takes

// At the start's place, or as far from the other end where that is where it was.
double elsewhere(double position, double length, int start) {
    const double there = places[start] * length;
    return std::abs(there - position) < 0.05 * length ? length - there : there;
}

// Of a shape; a start of a file or in equilibrium is scaled or stays.
Start other_start(const String& s, int start) {
    const Start& own = *s.start;
    const double length = s.length;
    const auto* mode = std::get_if<ModeShape>(&own);
    const auto* triangle = std::get_if<TriangleShape>(&own);
    if (!mode && !triangle) return *scaled(s, sizes[start]).start;
    const double amplitude = sizes[start] * (mode ? mode->amplitude : triangle->amplitude);
    if (start == 2) return ModeShape{mode ? mode->number + 4 : 5, amplitude};
    const double position = elsewhere(triangle ? triangle->position : 0, length, start);
    const double sharp = plectrum * length,
                 smoothing = triangle ? triangle->smoothing : 0.05 * length;
    return TriangleShape{position, amplitude, start == 1 ? std::min(sharp, smoothing) : smoothing};
}
}  // namespace

Scene started(Scene scene, int start) {
    if (start == 0) return scene;
    for (String& s : scene.strings) {
        if (s.start) s.start = other_start(s, start);
        if (!s.pluck) continue;
        s.pluck->amplitude *= sizes[start];
        if (s.pluck->time.empty()) s.pluck->duration *= shortest[start];
        if (s.pluck->width < 0.2 * s.length)
            s.pluck->position = elsewhere(s.pluck->position, s.length, start);
    }
    return scene;
}

std::string name_of_start(const Scene& scene) {
    for (const String& s : scene.strings) {
        if (s.pluck)
            return fmt::format("a pluck of {:.3g} N in {:.3g} s at {:.3g} m", s.pluck->amplitude,
                               s.pluck->duration, s.pluck->position);
        if (!s.start) continue;
        if (const auto* m = std::get_if<ModeShape>(&*s.start))
            return fmt::format("mode {}, {:.3g} m", m->number, m->amplitude);
        if (const auto* table = std::get_if<TableStart>(&*s.start)) return table->file;
        if (const auto* t = std::get_if<TriangleShape>(&*s.start))
            return fmt::format("a {}triangle at {:.3g} m, {:.3g} m",
                               t->smoothing > plectrum * s.length ? "smoothed " : "", t->position,
                               t->amplitude);
    }
    return "at rest";
}

}  // namespace jvari::bench::trim
