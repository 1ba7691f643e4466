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
                     square = omega_squared_damped(omega0, sigma);
        c.Ct.push_back(std::exp(-2 * sigma * dt));  // (14)
        const ModeStep step = exact_step(omega0, sigma, dt);
        c.loss.push_back(step.loss);  // dt C3 in (17), (18)
        c.kappa.push_back(step.num);  // 1 + C~ - C, dt^2 C2 in (17), (18)
        const ExactWay way = exact_way(omega0, sigma, dt);
        c.start.push_back(way.start);
        c.drift.push_back(way.drift());
        if (square > 0 && std::sqrt(square) * dt > std::numbers::pi) ++c.above_nyquist;
        const bool exact = omega0 * dt < exact_below && sigma * dt < 1;
        c.velocity.push_back(exact ? 0.5 * way.rate / way.decay : 0.0);
    }
    return c;
}

}  // namespace jvari
