#include "schemes/trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jvari {

namespace {
double largest(std::span<const double> x) {
    double most = 0;
    for (const double v : x) most = std::max(most, std::abs(v));
    return most;
}
}  // namespace

long row_at(double seconds, double rate) {
    const double row = std::ceil(seconds * rate - 1e-6);
    return row > 0 ? static_cast<long>(
                         std::min(row, 0.5 * static_cast<double>(std::numeric_limits<long>::max())))
                   : 0;  // "until the end" is a very late instant
}

double relative_difference(std::span<const double> a, std::span<const double> b) {
    const std::size_t rows = std::min(a.size(), b.size());
    const double scale = largest(b.first(rows));
    if (scale == 0)
        return largest(a.first(rows)) == 0 ? 0 : std::numeric_limits<double>::infinity();
    double difference = 0, norm = 0;
    for (std::size_t n = 0; n < rows; ++n) {
        const double d = a[n] / scale - b[n] / scale, r = b[n] / scale;
        difference += d * d;
        norm += r * r;
    }
    return std::sqrt(difference / norm);
}

double agree_until(std::span<const double> a, std::span<const double> b, double rate,
                   double level) {
    const double scale = largest(b), unit = scale > 0 ? scale : 1;
    double difference = 0, norm = 0;
    for (std::size_t n = 0; n < b.size(); ++n) {
        if (n >= a.size() || !std::isfinite(a[n]))
            return n == 0 ? 0 : static_cast<double>(n - 1) / rate;
        const double d = a[n] / unit - b[n] / unit, r = b[n] / unit;
        difference += d * d;
        norm += r * r;
        if (std::sqrt(difference) > level * std::sqrt(scale > 0 ? std::max(norm, 1.0) : 0.0))
            return static_cast<double>(n) / rate;
    }
    return b.empty() ? 0 : static_cast<double>(b.size() - 1) / rate;
}

}  // namespace jvari
