#include "reference/exact/pluck_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/exact/oscillators.hpp"
#include "scenes/excitation.hpp"

namespace jvari {

double pluck_window(const Pluck& e) {
    return e.time.empty() ? e.duration / (8 * std::max(1.0, std::abs(e.skew))) : HUGE_VAL;
}

void pluck_series(const Pluck& e, double u, double h, int count, double* c) {
    if (!e.time.empty()) {
        constexpr double rounding = 1e-6;  // for a line: no window begins so near its end
        const double t = e.start + u;
        std::size_t k = line_at(e, t);
        if (k + 2 < e.time.size() && e.time[k + 1] - t < rounding * (e.time[k + 1] - e.time[k]))
            ++k;
        const double slope = (e.share[k + 1] - e.share[k]) / (e.time[k + 1] - e.time[k]);
        std::fill_n(c, count, 0.0);
        c[0] = e.amplitude * (e.share[k] + slope * (t - e.time[k]));
        if (count > 1) c[1] = e.amplitude * slope * h;
        return;
    }
    // h_e is even in the skew
    const double k = std::abs(e.skew), x = u / e.duration, step = h / e.duration;
    // warped(x) = sinh(kx)/sinh(k) and its slope k cosh(kx)/sinh(k), written like in
    // scenes/excitation.cpp: no overflow, limits x and 1.
    const double warped =
        k == 0 ? x : std::exp(k * (x - 1)) * std::expm1(-2 * k * x) / std::expm1(-2 * k);
    const double warped_slope =
        k == 0 ? 1 : k * (std::exp(k * (x - 1)) + std::exp(-k * (x + 1))) / -std::expm1(-2 * k);
    double phase[longest_series] = {}, sine[longest_series] = {}, cosine[longest_series] = {};
    double power = 1;  // (k step)^n/n! for even n, k^(n-1) step^n/n! for odd n
    for (int n = 0; n < count; ++n) {
        const bool odd = n % 2 == 1;
        if (n > 0) power *= (odd ? step : k * k * step) / n;
        // pi h_e/tau_e  (15)
        phase[n] = std::numbers::pi / 2 *
                   ((n == 0   ? x
                     : n == 1 ? step
                              : 0) +
                    (odd ? warped_slope : warped) * power);
    }
    sine[0] = std::sin(phase[0]);
    cosine[0] = std::cos(phase[0]);
    // n s_n = sum_j j phase_j c_(n-j), n c_n = -sum_j j phase_j s_(n-j)
    for (int n = 1; n < count; ++n) {
        double s = 0, o = 0;
        for (int j = 1; j <= n; ++j) {
            s += j * phase[j] * cosine[n - j];
            o -= j * phase[j] * sine[n - j];
        }
        sine[n] = s / n;
        cosine[n] = o / n;
    }
    for (int n = 0; n < count; ++n) {
        double square = 0;
        for (int j = 0; j <= n; ++j) square += sine[j] * sine[n - j];
        c[n] = e.amplitude * square;  // (14)
    }
}

}  // namespace jvari
