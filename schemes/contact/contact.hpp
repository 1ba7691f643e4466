// THE contact equation. Every scheme ends at the same scalar problem: with a the older displacement
// of the contact point, r its unknown increment, b minus the force-free increment and theta the
// scheme's compliance [m/N],
//
//     r + b + theta [V(h - a - r) - V(h - a)]/r = 0,      V(eta) = k [eta]^(alpha+1)/(alpha+1)
//
// Two-point schemes: a = y^n, r = y^{n+1} - y^n (van Walstijn et al. 2016, eq 48). Three-point: a =
// u^{n-1}, r = u^{n+1} - u^{n-1} (Issanchou et al. 2016, eq 16). Monotone in r, so the root is
// unique. A loss makes the bracket (1 - kappa r) times as large (contact_gram.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "schemes/impacts.hpp"

namespace jvari {

// 2 a if this is a small whole number, otherwise 0.
inline int halves_in(double a) {
    const int halves = a <= 6 ? static_cast<int>(2 * a) : 0;
    return halves == 2 * a ? halves : 0;
}
// x^(halves/2), x >= 0. root: of x, for an odd number of halves
inline double power_of_halves(double x, double root, int halves) {
    double product = halves % 2 == 1 ? root : 1;
    for (int i = halves / 2; i > 0; --i) product *= x;
    return product;
}
// x^a, x >= 0. Halves of whole numbers, such as Hertz's exponent, take a root and products.
inline double power(double x, double a) {
    const int halves = halves_in(a);
    if (halves <= 0) return std::pow(x, a);
    return power_of_halves(x, halves % 2 == 1 ? std::sqrt(x) : 1, halves);
}

struct ContactLaw {
    double k = 0;      // [N/m^alpha]
    double alpha = 1;  // exponent

    bool rigid() const { return std::isinf(k); }  // the barrier does not give way
    double potential(double eta) const {          // V [J]
        if (eta <= 0) return 0;
        return alpha == 1 ? 0.5 * k * eta * eta : k * power(eta, alpha + 1) / (alpha + 1);
    }
    double force(double eta) const {  // V' [N]
        if (eta <= 0) return 0;
        return alpha == 1 ? k * eta : k * power(eta, alpha);
    }
    double slope(double eta) const {  // V'' [N/m]
        if (eta <= 0) return 0;
        return alpha == 1 ? k : alpha * k * power(eta, alpha - 1);
    }
};

// Hunt & Crossley 1975 over a step: F = G (1 - kappa r), G the force of the spring alone. F' = G' -
// kappa (r G)' <= 0, since G falls and r G, the energy given, rises: one solution. The loss is
// kappa G r^2 >= 0. F pulls only if the contact opens faster than 1/beta, like the law. Clipped, F
// = 0 there.
struct StepLoss {
    double kappa = 0;  // beta/span [1/m]
    bool clipped = false;
    double factor(double r) const { return clipped ? std::max(0.0, 1 - kappa * r) : 1 - kappa * r; }
};

struct Contacts {  // the contacts on a string
    std::vector<ContactLaw> laws;
    std::vector<double> heights;  // [m]
    std::vector<double> loss;     // Hunt-Crossley beta [s/m]
    std::vector<LossLaw> loss_law;
    std::vector<BarrierOf> of;
    std::vector<double> sign;  // -1: the contact's coordinate is -y

    int count() const { return static_cast<int>(laws.size()); }
    bool any_rigid() const {
        return std::any_of(laws.begin(), laws.end(), [](const ContactLaw& l) { return l.rigid(); });
    }
    void add(const ContactLaw& law, double height, double beta,
             LossLaw loss_by = LossLaw::hunt_crossley, BarrierOf barrier = {}, double way = 1) {
        laws.push_back(law);
        heights.push_back(height);
        loss.push_back(beta);
        loss_law.push_back(loss_by);
        of.push_back(barrier);
        sign.push_back(way);
    }
    void add(const Contacts& more, int string) {
        for (int a = 0; a < more.count(); ++a)
            add(more.laws[a], more.heights[a], more.loss[a], more.loss_law[a],
                {string, more.of[a].barrier, more.of[a].barriers});
    }
};

struct ForceRange {  // range of the contact forces on the string, over a run [N]
    double least = 0, most = 0;
    void note(double force) {
        least = std::min(least, force);
        most = std::max(most, force);
    }
};

struct ContactSolution {
    double r = 0;        // increment of the contact point [m]
    double force = 0;    // mean force on the string over the step, >= 0 without loss [N]
    int iterations = 0;  // 0: closed form
    bool converged = true;
    // residual of the equation at the last iterate, before its final correction, relative to its
    // largest term
    double residual = 0;
};

// Exponent 1: four cases (van Walstijn et al. 2016, fig 4). eta = h - a, phi = theta k/2. Written
// so that no case subtracts two numbers that a stiff contact (phi >> 1) makes nearly equal.
inline ContactSolution solve_linear_contact(double k, double eta, double b, double theta) {
    const double phi = 0.5 * theta * k;
    if (eta <= 0 && eta + b <= 0) return {-b, 0.0};  // stays out
    if (eta > 0) {
        if (eta * (1 - phi) + b > 0)  // stays in: eta - r > 0
            return {(2 * phi * eta - b) / (1 + phi), k * (eta + 0.5 * b) / (1 + phi)};
        const double root = std::sqrt(b * b + 4 * phi * eta * eta);  // leaves
        const double r = b > 0 ? 2 * phi * eta * eta / (b + root) : 0.5 * (root - b);
        return {r, 0.5 * k * eta * eta / r};
    }
    // enters: depth x = eta - r solves (1 + phi) x^2 + (gap - free) x - free gap = 0, gap = -eta,
    // free = eta + b > 0
    const double gap = -eta, free = eta + b, p = gap - free;
    const double root = std::sqrt(p * p + 4 * (1 + phi) * free * gap);
    const double x = p > 0 ? 2 * free * gap / (p + root) : 0.5 * (root - p) / (1 + phi);
    return {-(gap + x), 0.5 * k * x / (gap + x) * x};
}

// Any exponent >= 1: leaving is analytic; staying and entering by Newton on a convex increasing
// function, from above its root.
ContactSolution solve_power_contact(const ContactLaw&, double eta, double b, double theta);

struct PowerQuotient {
    double value, slope;
};
// ((1+z)^p - 1)/z and its derivative, z >= -1, with the limits p and p (p-1)/2 at z = 0
PowerQuotient power_quotient(double p, double z);

// Depth eta with eta + S V'(eta) = zeta: for a contact held back by a compliance S [m/N] in series.
// zeta itself if negative.
double depth_in_series(const ContactLaw&, double zeta, double S);

inline ContactSolution solve_contact(const ContactLaw& law, double eta, double b, double theta) {
    return law.alpha == 1 ? solve_linear_contact(law.k, eta, b, theta)
                          : solve_power_contact(law, eta, b, theta);
}

}  // namespace jvari
