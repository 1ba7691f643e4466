// Newton's method from above on increasing functions, kept in a bracket; where V is steep the compliance in series carries the step.
#include "schemes/contact/series_contact.hpp"

#include <limits>

namespace jvari {

namespace {
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int most_iterations = 100;
}  // namespace

double SeriesLaw::power_depth(double zeta) const {
    if (S == 0) return zeta;
    double eta = std::min(zeta, std::pow(zeta / (S * law.k), 1 / law.alpha));  // both are above the root, and the function is convex
    for (int i = 0; i < most_iterations; ++i) {
        const double load = S * law.k * std::pow(eta, law.alpha);
        const double step = (eta + load - zeta) / (1 + law.alpha * load / eta);
        eta -= step;
        if (!(std::abs(step) > 1e-9 * eta)) break;
    }
    return std::max(eta, 0.0);
}

ContactSolution solve_series_contact(const SeriesLaw& series, double zeta, double b, double theta) {
    if (zeta <= 0 && zeta + b <= 0) return {-b, 0.0};  // stays out
    const ContactLaw& law = series.law;
    const double p = law.alpha + 1, S = series.S;
    if (b * epsilon > zeta) zeta = std::min(zeta, 0.0);  // an approach below the rounding of the step is none
    const double eta = std::max(series.depth(zeta), 0.0), F0 = law.force(eta);
    const double stored = law.potential(eta) + 0.5 * S * F0 * F0;
    if (zeta > 0 && theta * stored >= zeta * (zeta + b)) {  // leaves: r >= zeta solves r^2 + b r - theta Phi = 0
        const double root = std::sqrt(b * b + 4 * theta * stored);
        const double r = b > 0 ? 2 * theta * stored / (b + root) : 0.5 * (root - b);
        return {r, stored / r};
    }
    ContactSolution s;
    double low = 0, high = series.depth(zeta + b), x = high;  // F >= 0
    for (s.iterations = 1; s.iterations <= most_iterations; ++s.iterations) {
        const double F1 = law.force(x), reach = x + S * F1;
        double mean, change;  // F and dF/dzeta+
        if (zeta > 0) {
            const double z = (x - eta) / eta, law_mean = law.k * std::pow(eta, law.alpha) / p * power_quotient(p, z).value;
            const double stiff = S * law.k * std::pow(eta, law.alpha - 1) * power_quotient(law.alpha, z).value;  // S dV'/d eta
            mean = (law_mean + 0.5 * (F0 + F1) * stiff) / (1 + stiff);
            const double moved = (x - eta) * (1 + stiff);
            const double tangent = law.slope(x);
            change = std::abs(z) > 1e-4 ? (F1 - mean) / moved : 0.5 * tangent / (1 + S * tangent);
        } else {
            mean = (law.potential(x) + 0.5 * S * F1 * F1) / (reach - zeta);
            change = (F1 - mean) / (reach - zeta);
        }
        const double residual = reach - zeta - b + theta * mean, size = reach + std::abs(zeta) + std::abs(b) + theta * mean;
        (residual > 0 ? high : low) = x;
        const double stretch = 1 + S * law.slope(x), step = residual / (stretch * (1 + theta * change));
        s.residual = std::abs(residual) / size;
        if (std::abs(step) <= 1e-8 * x || std::abs(residual) <= 4 * epsilon * size) {
            s.force = std::max(mean - change * stretch * step, 0.0);
            s.r = theta * s.force - b;
            return s;
        }
        const double next = x - step;
        x = next > low && next < high ? next : low > 0 ? 0.5 * (low + high) : 0.1 * high;
    }
    s.converged = false;
    return s;
}

}  // namespace jvari
