// Power-law contact: the one root of  g(r) = r + b + theta [V(eta - r) - V(eta)]/r  by safeguarded Newton.
#include "schemes/contact.hpp"

namespace jvari {

ContactSolution solve_power_contact(const ContactLaw& law, double eta, double b, double theta) {
    if (eta <= 0 && eta + b <= 0) return {-b, 0.0};  // stays out
    const double V0 = law.potential(eta);
    if (eta > 0) {  // leaves: V(eta - r) = 0, a quadratic
        const double root = std::sqrt(b * b + 4 * theta * V0);
        const double r = b > 0 ? 2 * theta * V0 / (b + root) : 0.5 * (root - b);
        if (r >= eta) return {r, V0 / r};
    }
    // The mean force Q(r) = [V(eta) - V(eta - r)]/r is >= 0 and falls with r; the root of r + b - theta Q(r) lies in [-b, eta].
    const auto mean_force = [&](double r) {
        const double eta1 = eta - r;
        if (eta <= 0) return law.potential(eta1) / -r;
        const double z = -r / eta;  // series of V0 ((1+z)^(alpha+1) - 1)/(z eta) for small z: no 0/0 at r -> 0
        const double a = law.alpha;
        if (std::abs(z) < 1e-4)
            return law.force(eta) * (1 + a / 2 * z * (1 + (a - 1) / 3 * z * (1 + (a - 2) / 4 * z * (1 + (a - 3) / 5 * z))));
        return V0 * std::expm1((a + 1) * std::log1p(z)) / (z * eta);
    };
    double low = -b, high = std::max(eta, -b);  // residual <= 0 at low, >= 0 at high
    if (eta <= 0) high = eta;
    double r = 0.5 * (low + high);
    ContactSolution s;
    for (s.iterations = 1; s.iterations <= 200; ++s.iterations) {
        const double Q = mean_force(r), residual = r + b - theta * Q;
        if (residual > 0) high = r;
        else low = r;
        // dQ/dr = [V'(eta - r) - Q]/r, its limit -V''(eta)/2
        const double slope = std::abs(r) > 1e-6 * std::abs(eta) ? (law.force(eta - r) - Q) / r : -0.5 * law.alpha * law.force(eta) / eta;
        double next = r - residual / (1 - theta * slope);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        const double change = std::abs(next - r);
        r = next;
        if (change <= 1e-15 * std::abs(r) || residual == 0) break;
    }
    s.r = r;
    s.force = mean_force(r);
    s.converged = s.iterations <= 200;
    return s;
}

}  // namespace jvari
