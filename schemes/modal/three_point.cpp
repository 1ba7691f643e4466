// Source: Issanchou et al. 2016, eqs 14, 17-18. Differences with cancellation (1 + C~ - C for a low
// mode) are written as products.
#include "schemes/modal/three_point.hpp"

#include <cmath>
#include <numbers>

#include "schemes/modal_coefficients.hpp"

namespace jvari {

ThreePoint three_point(const Modes& modes, double dt, double exact_below) {
    ThreePoint c;
    c.gain = dt * dt / modes.mass;
    for (int j = 0; j < modes.count(); ++j) {
        const double sigma = modes.sigma[j], omega0 = modes.omega0[j],
                     decay = std::exp(-sigma * dt), fallen = std::expm1(-sigma * dt);
        const double square = omega_squared_damped(omega0, sigma);
        c.Ct.push_back(std::exp(-2 * sigma * dt));  // (14)
        const ModeStep step = exact_step(omega0, sigma, dt);
        c.loss.push_back(step.loss);  // dt C3 in (17), (18)
        c.kappa.push_back(step.num);  // 1 + C~ - C, dt^2 C2 in (17), (18)
        double rate;                  // omega/sin(omega dt), its limit or its hyperbolic form
        if (square > 0) {
            const double omega = std::sqrt(square), half = std::sin(0.5 * omega * dt),
                         sine = std::sin(omega * dt);
            c.start.push_back(fallen + decay * (sigma / omega * sine - 2 * half * half));
            rate = omega / sine;
            if (omega * dt > std::numbers::pi) ++c.above_nyquist;
        } else if (square < 0) {
            // slow = sigma - s
            const double s = std::sqrt(-square), slow = omega0 * omega0 / (sigma + s),
                         fast = sigma + s;
            const double slowly = std::expm1(-slow * dt), quickly = std::expm1(-fast * dt);
            c.start.push_back((fast * slowly - slow * quickly) / (2 * s));
            rate = s / std::sinh(s * dt);
        } else {
            c.start.push_back(fallen + decay * sigma * dt);
            rate = 1 / dt;
        }
        c.drift.push_back(decay / rate);
        const bool exact = omega0 * dt < exact_below && sigma * dt < 1;
        c.velocity.push_back(exact ? 0.5 * rate / decay : 0.0);
    }
    return c;
}

}  // namespace jvari
