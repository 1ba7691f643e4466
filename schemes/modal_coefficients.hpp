// One mode stepped over dt, in the two forms that the papers use; exact for free motion, also where
// a mode is overdamped.
//
// With R = exp(-sigma dt), Omega = cos(omega dt) (cosh where overdamped), num = 1 - 2 R Omega + R^2
// and den = 1 + 2 R Omega + R^2:
//     two-point   A = num/den, B = 2 (1 - R^2)/den     van Walstijn et al. 2016, eq 33
//     three-point C = 2 R Omega, C~ = R^2              Issanchou et al. 2016, eq 14
// num and den are formed without cancellation, so that low modes stay exact at high rates. Neither
// is negative, which is the stability of the three-point form (Issanchou et al. 2016, eq 23).
#pragma once

#include <algorithm>
#include <cmath>

#include "schemes/scheme.hpp"

namespace jvari {

struct ModeStep {
    double num, den;                                // see above
    double loss;                                    // 1 - R^2
    double C() const { return 0.5 * (den - num); }  // (14)
    double C_tilde() const { return 1 - loss; }
    double A() const { return num / den; }  // (33)
    double B() const { return 2 * loss / den; }
};

inline ModeStep exact_step(double omega0, double sigma, double dt) {
    const double square = (omega0 - sigma) * (omega0 + sigma);  // omega^2
    const double loss = -std::expm1(-2 * sigma * dt);
    if (square >= 0) {
        const double R = std::exp(-sigma * dt), E = std::expm1(-sigma * dt),
                     half = 0.5 * std::sqrt(square) * dt;
        const double s = std::sin(half), c = std::cos(half);
        return {E * E + 4 * R * s * s, E * E + 4 * R * c * c, loss};
    }
    // the two real roots
    const double gamma = std::sqrt(-square), slow = omega0 * omega0 / (sigma + gamma),
                 fast = sigma + gamma;
    return {std::expm1(-slow * dt) * std::expm1(-fast * dt),
            (1 + std::exp(-slow * dt)) * (1 + std::exp(-fast * dt)), loss};
}

// Free motion over one step: x(dt) = (1 + start) x(0) + drift() v(0).
struct ExactWay {
    double start, decay, rate;  // rate: omega/sin(omega dt), its limit or its hyperbolic form
    double drift() const { return decay / rate; }
};
inline ExactWay exact_way(double omega0, double sigma, double dt) {
    const double square = (omega0 - sigma) * (omega0 + sigma), decay = std::exp(-sigma * dt),
                 fallen = std::expm1(-sigma * dt);
    if (square > 0) {
        const double omega = std::sqrt(square), half = std::sin(0.5 * omega * dt),
                     sine = std::sin(omega * dt);
        return {fallen + decay * (sigma / omega * sine - 2 * half * half), decay, omega / sine};
    }
    if (square < 0) {
        // slow = sigma - s
        const double s = std::sqrt(-square), slow = omega0 * omega0 / (sigma + s), fast = sigma + s,
                     slowly = std::expm1(-slow * dt), quickly = std::expm1(-fast * dt);
        return {(fast * slowly - slow * quickly) / (2 * s), decay, s / std::sinh(s * dt)};
    }
    return {fallen + decay * sigma * dt, decay, 1 / dt};
}

// The root of (1 + A + B) z^2 - 2 (1 - A) z + 1 + A - B = 0, the two-point recursion with
// coefficients A, B (eqs 34-35).
inline FreeMode two_point_mode(double A, double B, double dt) {
    return {std::atan2(std::sqrt(std::max(0.0, 4 * A - B * B)), 1 - A) / dt,
            -0.5 * std::log1p(-2 * B / (1 + A + B)) / dt};
}

// The root of z^2 - C z + C~ = 0, the three-point recursion, from num = 1 + C~ - C and loss = 1 -
// C~.
inline FreeMode three_point_mode(double num, double loss, double dt) {
    // lost = 1 - R
    const double R = std::sqrt(1 - loss), lost = loss / (1 + R), C = 2 - loss - num;
    return {std::atan2(std::sqrt(std::max(0.0, (num - lost * lost) * (2 * R + C))), C) / dt,
            -0.5 * std::log1p(-loss) / dt};
}

}  // namespace jvari
