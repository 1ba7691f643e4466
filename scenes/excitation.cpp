// Source: van Walstijn et al. 2016, eqs 14-15 (pluck). The smoothed triangle is the string's modal series times a Hann window's spectrum.
#include "scenes/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace jvari {

using std::numbers::pi;

double force(const Pluck& e, double t) {
    const double u = t - e.start;
    if (u < 0 || u > e.duration) return 0;
    const double ratio = u / e.duration;
    // sinh(s x)/sinh(s) = exp(s(x-1)) (1 - exp(-2 s x))/(1 - exp(-2 s)): no overflow; the limit x for s -> 0.
    const double warped = e.skew == 0 ? ratio : std::exp(e.skew * (ratio - 1)) * std::expm1(-2 * e.skew * ratio) / std::expm1(-2 * e.skew);
    const double h = 0.5 * (ratio + warped);  // h_e/tau_e  (15)
    const double sine = std::sin(pi * h);
    return e.amplitude * sine * sine;  // (14)
}

double free_from(const Scene& scene) {
    double end = 0;
    for (const String& s : scene.strings)
        if (s.pluck && s.pluck->amplitude != 0 && s.pluck->start < scene.duration) end = std::max(end, s.pluck->start + s.pluck->duration);
    return end;
}

double hann_smoothing(double beta, double s) {
    const double z = 0.5 * beta * s;
    if (z == 0) return 1;
    const double gap = 1 - z / pi;
    if (std::abs(gap) < 1e-6) return 0.5 * (1 + 1.5 * gap);  // sin z/z/((1-z/pi)(1+z/pi)) about z = pi
    return std::sin(z) / z / (gap * (1 + z / pi));
}

double coefficient(const TriangleInitial& t, double length, int mode) {
    const double beta = mode * pi / length, x0 = t.position, number = mode;  // its square passes what an int holds
    return 2 * t.amplitude * length * length / (number * number * pi * pi * x0 * (length - x0)) * std::sin(beta * x0) *
           hann_smoothing(beta, t.smoothing);
}

}  // namespace jvari
