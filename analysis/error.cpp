// Source: the definitions of error.hpp; the sums are those of schemes/trace.hpp.
#include "analysis/error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace jvari {

namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

double largest(std::span<const double> x) {  // NaN where any value is
    double most = 0;
    for (double v : x) most = std::isnan(most) || std::isnan(v) ? nan : std::max(most, std::abs(v));
    return most;
}

void same_taps(const Trace& a, const Trace& b) {
    if (a.names != b.names) throw std::invalid_argument("the two traces have different taps");
    if (a.tap_rate != b.tap_rate)
        throw std::invalid_argument(
            "the two traces have different tap rates: " + std::to_string(a.tap_rate) + " and " +
            std::to_string(b.tap_rate) + " Hz");
}
}  // namespace

double relative_l2(std::span<const double> candidate, std::span<const double> reference,
                   double rate, Window window) {
    const long have = static_cast<long>(reference.size());
    const long from = row_at(window.from, rate),
               to = std::isinf(window.to) ? have : row_at(window.to, rate);
    if (from >= to || to > have) return nan;
    if (to > static_cast<long>(candidate.size())) return inf;
    const auto a = candidate.subspan(from, to - from), b = reference.subspan(from, to - from);
    const double scale = largest(b);
    if (!std::isfinite(scale)) return nan;
    if (!std::all_of(a.begin(), a.end(), [](double v) { return std::isfinite(v); })) return inf;
    if (scale == 0) return largest(a) == 0 ? 0 : nan;
    return relative_difference(a, b);
}

double horizon(std::span<const double> candidate, std::span<const double> reference, double rate,
               double threshold) {
    if (reference.empty() || !std::isfinite(largest(reference))) return nan;
    return agree_until(candidate, reference, rate, threshold);
}

TapErrors relative_l2(const Trace& candidate, const Trace& reference, Window window) {
    same_taps(candidate, reference);
    TapErrors errors{{}, reference.taps() > 0 ? 0 : nan, nan};
    double squares = 0;
    for (int k = 0; k < reference.taps(); ++k) {
        const double e =
            relative_l2(candidate.column(k), reference.column(k), reference.tap_rate, window);
        errors.tap.push_back(e);
        if (std::isinf(errors.worst) || std::isinf(e)) errors.worst = inf;
        // a NaN stays until an infinity
        else if (!(e <= errors.worst)) errors.worst = std::isnan(errors.worst) ? nan : e;
        squares += e * e;
    }
    if (reference.taps() > 0)
        errors.combined =
            std::isfinite(errors.worst) ? std::sqrt(squares / reference.taps()) : errors.worst;
    return errors;
}

TapHorizons horizon(const Trace& candidate, const Trace& reference, double threshold) {
    same_taps(candidate, reference);
    TapHorizons horizons{{}, reference.taps() > 0 ? inf : nan};
    for (int k = 0; k < reference.taps(); ++k) {
        horizons.tap.push_back(
            horizon(candidate.column(k), reference.column(k), reference.tap_rate, threshold));
        horizons.shortest = std::fmin(horizons.shortest, horizons.tap.back());
    }
    return horizons;
}

}  // namespace jvari
