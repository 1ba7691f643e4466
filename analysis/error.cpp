// Implements the definitions in error.hpp by the sums in schemes/trace.hpp.
#include "analysis/error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace jvari {

namespace {
double largest(std::span<const double> x) {  // NaN if any value is NaN
    double most = 0;
    for (double v : x) most = std::isnan(most) || std::isnan(v) ? nan : std::max(most, std::abs(v));
    return most;
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

std::vector<double> relative_l2(const Trace& a, const Trace& b, Window window) {
    if (a.names != b.names) throw std::invalid_argument("the two traces have different taps");
    if (a.tap_rate != b.tap_rate)
        throw std::invalid_argument(
            "the two traces have different tap rates: " + std::to_string(a.tap_rate) + " and " +
            std::to_string(b.tap_rate) + " Hz");
    std::vector<double> errors;
    for (int k = 0; k < b.taps(); ++k)
        errors.push_back(relative_l2(a.column(k), b.column(k), b.tap_rate, window));
    return errors;
}

}  // namespace jvari
