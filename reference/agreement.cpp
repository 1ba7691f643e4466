#include "reference/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "scenes/start.hpp"

namespace jvari {

namespace {
// ratio between successive doublings: order 1/2
constexpr double slowest = 0.70710678118654752;
}  // namespace

std::span<const double> rows_from(std::span<const double> x, double seconds, double rate) {
    return x.subspan(std::min(x.size(), static_cast<std::size_t>(row_at(seconds, rate))));
}

double relative_difference(std::span<const double> a, std::span<const double> b, double rate,
                           double until) {
    const auto within = [&](std::span<const double> x) {
        const double length = static_cast<double>(x.size()) / rate;
        return until < length
                   ? x.first(std::min(x.size(), static_cast<std::size_t>(row_at(until, rate))))
                   : x;
    };
    return relative_difference(within(a), within(b));
}

Agreement agreement(std::span<const double> a, std::span<const double> b, double rate) {
    Agreement result;
    for (std::size_t w = 0; w < agreement_windows.size(); ++w)
        result.relative_l2[w] = relative_difference(a, b, rate, agreement_windows[w]);
    for (std::size_t l = 0; l < agreement_levels.size(); ++l)
        result.until[l] = agree_until(a, b, rate, agreement_levels[l]);
    return result;
}

double left_after(std::span<const double> changes, bool matched) {
    if (changes.empty()) return std::numeric_limits<double>::quiet_NaN();
    const double last = changes.back();
    const double of_order_half = and_further_ones - 1;
    if (changes.size() == 1)
        return matched ? (matched_and_further_ones - 1) * last : of_order_half * last;
    const auto earlier = changes.first(changes.size() - 1);
    const double before = earlier.back();
    if (last > 0 && last >= *std::max_element(earlier.begin(), earlier.end()))
        return std::numeric_limits<double>::quiet_NaN();
    const double ratio = last / before;
    if (!(ratio <= slowest)) return of_order_half * std::fmax(last, before);
    const double series = last * ratio / (1 - ratio);
    return matched ? std::max(series, of_order_half * last)
                   : std::max({series, last, before - last});
}

double no_less(double left_out, double apart, double change) {
    return apart > change ? std::max(left_out, apart) : left_out;  // NaN stays NaN
}

std::vector<double> extrapolated(std::span<const double> own, std::span<const double> of_half) {
    std::vector<double> y(std::min(own.size(), of_half.size()));
    for (std::size_t n = 0; n < y.size(); ++n) y[n] = 2 * own[n] - of_half[n];
    return y;
}

Scene moved(Scene scene, double factor) {
    for (String& s : scene.strings) s = scaled(std::move(s), factor);
    return scene;
}

}  // namespace jvari
