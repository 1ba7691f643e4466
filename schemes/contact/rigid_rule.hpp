// Barriers that do not give way, in two-point steps: the limit of the discrete gradient (gradient_rule.hpp) for k -> infinity. What then
// gives way is Theta alone: the modes over the step, and with compliance=matched the element that stands for the modes left out, a contact
// point without mass (Monjaraz-Tec, Gross & Krack 2022, "massless boundary component mode synthesis"). No law of impact is needed.
//
// A spring that gets ever stiffer gives way by nothing, but its energy V = k eta^2/2 has a limit. So each contact has one state, V, which
// is not 0 only in a step in which it lies on its barrier. With b and gap = -eta before the step, r = -b + Theta F,
//
//     V = 0:   0 <= F,   0 <= gap + r,   F (gap + r) = 0,   V+ = F gap     stays out; or comes to lie on the barrier, or stays there
//     V > 0:   F r = V,  r > 0,   V+ = 0                                   what struck the barrier is thrown back by what it gave
//
// The first line is a linear complementarity problem. It constrains the new position, not the mean: a point that strikes does so F gap
// before the step ends, and the second line returns this. The invariant of obstacle_rule.hpp holds exactly with potential = V; F never
// pulls; no energy is gained whatever the step. Several contacts: the same in turn, each with the others' forces held (Gauss-Seidel on a
// convex problem: Theta is a Gram matrix), until no force changes. Leaves out: three-point steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class RigidRule {
public:
    static constexpr bool conserves = true, iterates = true, centred = false;

    RigidRule(std::span<const ContactLaw> laws, std::span<const double> theta, int)
        : theta_(theta.begin(), theta.end()), stored_(laws.size(), 0.0) {}
    int dofs() const { return static_cast<int>(stored_.size()); }
    void set(std::span<const double> theta) noexcept { std::copy(theta.begin(), theta.end(), theta_.begin()); }
    void begin(const double*) { std::fill(stored_.begin(), stored_.end(), 0.0); }
    bool acts(const BeforeStep& at) const {
        bool touching = false;
        for (std::size_t a = 0; a < stored_.size(); ++a) touching = touching || stored_[a] > 0 || at.older[a] + at.b[a] > 0;
        return touching;
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept;
    GramSolution start(const BeforeStep& at, double* r, double* force) noexcept { return solve(at, r, force); }
    double potential(int a, double) const { return stored_[a]; }
    std::vector<Fact> facts() const { return {}; }

private:
    static constexpr int most_sweeps = 10000;
    double held(std::size_t a, const double* force) const {  // sum of Theta F over the others
        double sum = 0;
        for (std::size_t c = 0; c < stored_.size(); ++c)
            if (c != a) sum += theta_[a * stored_.size() + c] * force[c];
        return sum;
    }
    double force_of(std::size_t a, double eta, double b) const {  // of a contact with the others' forces held in b
        const double theta = theta_[a * stored_.size() + a], V = stored_[a];
        if (V <= 0) return std::max(0.0, (eta + b) / theta);
        const double root = std::sqrt(b * b + 4 * theta * V);  // r^2 + b r - theta V = 0
        return b > 0 ? 0.5 * (b + root) / theta : 2 * V / (root - b);
    }

    std::vector<double> theta_, stored_;  // V of each contact [J]
};

inline GramSolution RigidRule::solve(const BeforeStep& at, double* r, double* force) noexcept {
    const std::size_t n = stored_.size();
    GramSolution s;
    s.converged = false;
    std::fill_n(force, n, 0.0);
    for (s.iterations = 1; s.iterations <= most_sweeps && !s.converged; ++s.iterations) {
        double change = 0, largest = 0;
        for (std::size_t a = 0; a < n; ++a) {
            const double F = force_of(a, at.older[a], at.b[a] - held(a, force));
            change = std::max(change, std::abs(F - force[a]));
            largest = std::max(largest, F);
            force[a] = F;
        }
        s.residual = largest > 0 ? change / largest : 0;
        s.converged = n == 1 || s.residual <= 4 * std::numeric_limits<double>::epsilon();
    }
    --s.iterations;
    if (n == 1) s = {};
    for (std::size_t a = 0; a < n; ++a) {
        r[a] = theta_[a * n + a] * force[a] + held(a, force) - at.b[a];
        stored_[a] = stored_[a] > 0 ? 0 : std::max(0.0, -force[a] * r[a]);
    }
    return s;
}

}  // namespace jvari
