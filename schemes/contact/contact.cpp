// Power-law contact: the one root of  r + b = theta Q(r),  Q(r) = [V(eta) - V(eta - r)]/r,  p =
// alpha + 1.
//
// Four cases, told apart without solving. Out: no force. Leaving (the new penetration is 0): a
// quadratic. Staying: with z = -r/eta,
//     G(z) = z - B + S ((1+z)^p - 1)/z = 0,   B = b/eta,   S = theta V(eta)/eta^2;
//     leaving is G(-1) >= 0.
// Entering from a gap e = -eta to the depth x, free depth f = b - e:
//     H(x) = x + T x^p/(e + x) - f = 0,       T = theta k/p.
// Both are increasing and convex for alpha >= 1, so Newton falls to the root from above and, from
// below, first steps above it; the bounds below start it within a few steps of the root for any
// stiffness. It stops on a relative step of 1e-8, whose square is below rounding.
#include "schemes/contact/contact.hpp"

#include <limits>

namespace jvari {

namespace {
// p half of a whole number n, s^2 = 1 + z: without a difference,
//     Q = (1 + s + ... + s^(n-1))/(1 + s),
//     Q' = (1 + 2 s + ... + (n-2) s^(n-3) + (n-2) s^(n-2)/2)/(1 + s)^2
PowerQuotient quotient_by_halves(int n, double z) {
    const double s = std::sqrt(1 + z), by = 1 / (1 + s);
    double sum = 0, weighted = 0, s_i = 1;  // s^i
    for (int i = 0; i < n - 2; ++i, s_i *= s) sum += s_i, weighted += (i + 1) * s_i;
    sum += s_i * (1 + s);
    weighted += 0.5 * (n - 2) * s_i;
    return {sum * by, weighted * by * by};
}
}  // namespace

PowerQuotient power_quotient(double p, double z) {
    if (const int halves = halves_in(p); halves > 0) return quotient_by_halves(halves, z);
    if (std::abs(z) < 1e-3) {
        const double c1 = p, c2 = c1 * (p - 1) / 2, c3 = c2 * (p - 2) / 3, c4 = c3 * (p - 3) / 4,
                     c5 = c4 * (p - 4) / 5, c6 = c5 * (p - 5) / 6;
        return {c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * c6)))),
                c2 + z * (2 * c3 + z * (3 * c4 + z * (4 * c5 + z * 5 * c6)))};
    }
    const double growth =
        z > -0.05 && z < 0.05 ? std::expm1(p * std::log1p(z)) : std::pow(1 + z, p) - 1;
    const double value = growth / z;
    const double force = z > -1 ? p * (1 + growth) / (1 + z) : 0.0;  // p (1+z)^alpha
    return {value, (force - value) / z};
}

namespace {
constexpr double epsilon = std::numeric_limits<double>::epsilon();
// 7 are seen at the worst up to exponent 5, 36 with exponent 50
constexpr int newton_steps = 60;

// scale = V(eta)/eta [N]
ContactSolution stay(double p, double scale, double eta, double B, double S) {
    ContactSolution s;
    // the tangent at 0: above the root, G being convex
    double z = (B - S * p) / (1 + 0.5 * S * p * (p - 1));
    // and by the second derivative there: no bound any more, but a start below only costs one step
    if (z < 1) {
        const double curve = S * p * (p - 1) * (p - 2) / 6;
        z -= curve * z * z / (1 + 0.5 * S * p * (p - 1) + 2 * curve * std::max(z, 0.0));
    } else {
        z = std::min(z, std::pow(B / S, 1 / (p - 1)));  // (1+z)^p - 1 > z^p
    }
    z = std::max(z, -1.0);
    for (s.iterations = 1; s.iterations <= newton_steps; ++s.iterations) {
        const auto [value, slope] = power_quotient(p, z);
        const double residual = z - B + S * value, size = std::abs(z) + std::abs(B) + S * value;
        const double step = residual / (1 + S * slope);
        const double next = std::max(z - step, -1.0);
        s.residual = std::abs(residual) / size;
        if (std::abs(step) <= 1e-8 * std::abs(next) || std::abs(residual) <= 4 * epsilon * size) {
            s.r = -next * eta;
            s.force = scale * (value + slope * (next - z));
            return s;
        }
        z = next;
    }
    s.converged = false;
    return s;
}

ContactSolution enter(double k, double p, double gap, double free, double theta) {
    ContactSolution s;
    const double T = theta * k / p;
    // x^p < free (gap + x)/T: the larger one of gap and x gives the bound, near the root if T x^p
    // carries the step
    const double carried = std::log(free / T);
    const double near = gap > 0 ? (carried + std::log(gap)) / p : -HUGE_VAL,
                 deep = carried / (p - 1);
    double x = std::min(free, std::exp(std::max(near, deep)));
    for (s.iterations = 1; s.iterations <= newton_steps; ++s.iterations) {
        // theta V(x)/(e + x)
        const double reach = gap + x, load = T * power(x, p - 1) * (x / reach);
        const double residual = x + load - free;
        const double slope = load * (p / x - 1 / reach);
        const double step = residual / (1 + slope);
        double next = x - step;
        if (!(next > 0)) next = 0.5 * x;
        next = std::min(next, free);
        s.residual = std::abs(residual) / free;
        if (std::abs(step) <= 1e-8 * next || std::abs(residual) <= 2 * epsilon * free) {
            s.r = -(gap + next);
            s.force = (load + slope * (next - x)) / theta;
            return s;
        }
        x = next;
    }
    s.converged = false;
    return s;
}
}  // namespace

double depth_in_series(const ContactLaw& law, double zeta, double S) {
    if (zeta <= 0 || S == 0) return zeta;
    if (law.alpha == 1) return zeta / (1 + S * law.k);
    // both are above the root, and the function is convex
    double eta = std::min(zeta, std::pow(zeta / (S * law.k), 1 / law.alpha));
    for (int i = 0; i < newton_steps; ++i) {
        const double load = S * law.k * power(eta, law.alpha);
        const double step = (eta + load - zeta) / (1 + law.alpha * load / eta);
        eta -= step;
        if (!(std::abs(step) > 1e-9 * eta)) break;
    }
    return std::max(eta, 0.0);
}

ContactSolution solve_power_contact(const ContactLaw& law, double eta, double b, double theta) {
    if (eta <= 0 && eta + b <= 0) return {-b, 0.0};  // stays out
    const double p = law.alpha + 1;
    if (eta <= 0) return enter(law.k, p, -eta, eta + b, theta);
    // a penetration below the rounding of the step counts for none
    if (b * epsilon > eta) return enter(law.k, p, 0.0, b, theta);
    const double B = b / eta, scale = law.k / p * power(eta, law.alpha), S = theta * scale / eta;
    if (S >= 1 + B) {  // leaves: rho = r/eta >= 1 solves rho^2 + B rho - S = 0
        const double root = std::sqrt(B * B + 4 * S);
        const double rho = B > 0 ? 2 * S / (B + root) : 0.5 * (root - B);
        return {rho * eta, scale / rho};
    }
    // If p is high, V(eta) can be below double's range or (1+z)^p above it: negligible beside V at
    // the new depth, but r still ends at eta.
    if (p > 12 && B > 1 &&
        (scale < std::numeric_limits<double>::min() ||
         !(p * std::log1p(std::min(B, std::pow(B / S, 1 / (p - 1)))) < 700)))
        return enter(law.k, p, -eta, eta + b, theta);
    return stay(p, scale, eta, B, S);
}

}  // namespace jvari
