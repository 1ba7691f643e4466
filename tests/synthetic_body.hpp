// A made-up body, for the measured responses of tanpuras are not published: what van Walstijn et
// al. 2016, fig. 5, describe in words.
//
// A simply supported plate, its lowest mode at 200 Hz, driven where the bridge or the nut stands;
// each mode loses f/30 a second. What lies below 200 Hz is taken away by a high pass of second
// order. Synthetic: no instrument has it.
// scenes/synthetic_bridge.wav and synthetic_nut.wav are what this makes; `jvari new body` hands
// them out.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace jvari::synthetic {

enum class BodyEnd { bridge, nut };
constexpr double synthetic_rate = 44100;  // [Hz]

namespace detail {
constexpr double pi = std::numbers::pi;
constexpr int rows = 2048, fading = rows / 8;
constexpr double lowest = 200, highest = 18e3;  // modes [Hz]
constexpr double quality = 30;
constexpr double ratio = 1.31;  // of the plate's sides

struct Place {
    double x, y;  // of each side
};
constexpr Place bridge{0.37, 0.42}, nut{0.11, 0.23}, listener{0.29, 0.19};

inline double shape(int m, int n, const Place& p) {
    return std::sin(m * pi * p.x) * std::sin(n * pi * p.y);
}

inline std::vector<double> plate(const Place& driven) {
    std::vector<double> h(rows, 0.0);
    for (int m = 1;; ++m) {
        const auto frequency = [m](int n) {
            return lowest * (m * m * ratio * ratio + n * n) / (ratio * ratio + 1);
        };
        if (frequency(1) > highest) return h;
        for (int n = 1; frequency(n) <= highest; ++n) {
            const double w = 2 * pi * frequency(n) / synthetic_rate, decay = w / (2 * quality);
            // large waves are heard best
            const double strength = w * shape(m, n, driven) * shape(m, n, listener) / (m * n);
            for (int k = 0; k < rows; ++k)
                h[k] += strength * std::exp(-decay * k) * std::sin(w * k);
        }
    }
}

// Butterworth of second order by the bilinear transform.
inline void high_pass(std::vector<double>& x, double corner) {
    const double k = std::tan(pi * corner / synthetic_rate),
                 a0 = 1 + std::numbers::sqrt2 * k + k * k;
    const double a1 = 2 * (k * k - 1) / a0, a2 = (1 - std::numbers::sqrt2 * k + k * k) / a0;
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
    for (double& v : x) {
        const double y = (v - 2 * x1 + x2) / a0 - a1 * y1 - a2 * y2;
        x2 = x1, x1 = v, y2 = y1, y1 = y;
        v = y;
    }
}

inline double largest_gain(const std::vector<double>& h) {
    double most = 0;
    for (int bin = 0; bin <= rows; ++bin) {
        std::complex<double> sum = 0;
        const std::complex<double> turn = std::polar(1.0, -pi * bin / rows);
        for (auto v = h.rbegin(); v != h.rend(); ++v) sum = sum * turn + *v;  // Horner
        most = std::max(most, std::abs(sum));
    }
    return most;
}

inline std::vector<double> unscaled(const Place& driven) {
    std::vector<double> h = plate(driven);
    high_pass(h, lowest);
    for (int k = 0; k < fading; ++k) h[rows - 1 - k] *= 0.5 - 0.5 * std::cos(pi * k / fading);
    return h;
}
}  // namespace detail

// 2048 rows at 44.1 kHz; the strongest mode of the bridge's answers a force with as much pressure
// [1/1].
inline std::vector<double> synthetic_response(BodyEnd end) {
    std::vector<double> h = detail::unscaled(detail::bridge);
    const double scale = 1 / detail::largest_gain(h);
    if (end == BodyEnd::nut) h = detail::unscaled(detail::nut);
    for (double& v : h) v *= scale;
    return h;
}

}  // namespace jvari::synthetic
