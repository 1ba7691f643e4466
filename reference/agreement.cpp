#include "reference/agreement.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

double relative_difference(std::span<const double> a, std::span<const double> b, double rate, double until) {
    const std::size_t rows = std::min(a.size(), b.size());
    double difference = 0, norm = 0;
    for (std::size_t n = 0; n < rows && static_cast<double>(n) <= until * rate * (1 + 1e-12); ++n) {
        difference += (a[n] - b[n]) * (a[n] - b[n]);
        norm += b[n] * b[n];
    }
    return difference == 0 ? 0 : std::sqrt(difference / norm);
}

double agree_until(std::span<const double> a, std::span<const double> b, double rate, double level) {
    const std::size_t rows = std::min(a.size(), b.size());
    double largest = 0, difference = 0, norm = 0;
    for (std::size_t n = 0; n < rows; ++n) largest = std::max(largest, std::abs(b[n]));
    for (std::size_t n = 0; n < rows; ++n) {
        difference += (a[n] - b[n]) * (a[n] - b[n]);
        norm += b[n] * b[n];
        if (!(std::sqrt(difference) <= level * std::max(std::sqrt(norm), largest))) return static_cast<double>(n) / rate;
    }
    return rows == 0 ? 0 : static_cast<double>(rows - 1) / rate;
}

Agreement agreement(std::span<const double> a, std::span<const double> b, double rate) {
    Agreement result;
    for (std::size_t w = 0; w < agreement_windows.size(); ++w)
        result.relative_l2[w] = relative_difference(a, b, rate, agreement_windows[w]);
    for (std::size_t l = 0; l < agreement_levels.size(); ++l) result.until[l] = agree_until(a, b, rate, agreement_levels[l]);
    return result;
}

}  // namespace jvari
