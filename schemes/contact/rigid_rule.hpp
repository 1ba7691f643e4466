// Barriers that do not give way: the limit of the discrete gradient (gradient_rule.hpp) for k ->
// infinity. Only Theta gives way then: the modes over the step and, with compliance=matched, the
// element that represents the modes left out, a contact point without mass (Monjaraz-Tec, Gross &
// Krack 2022, "massless boundary component mode synthesis"). No law of impact is needed.
//
// A spring that gets ever stiffer gives way by nothing, but its energy V = k eta^2/2 has a limit.
// So each contact has one state, V, which is nonzero only in a step in which the contact lies on
// its barrier. With b and gap = -eta before the step, r = -b + Theta F,
//
//     V = 0:   0 <= F,   0 <= gap + r,   F (gap + r) = 0,   V+ = F gap
//              stays out; or comes to lie on the barrier, or stays there
//     V > 0:   F r = V,   r > 0,   V+ = 0
//              a point that struck the barrier gets its energy back and is thrown off
//
// The first line is a linear complementarity problem. It constrains the new position, not the mean:
// a striking point does the work F gap before the step ends, and the second line returns this work.
// The invariant in obstacle_rule.hpp holds exactly with potential = V; F never pulls; no energy is
// gained whatever the step. Several contacts are solved in turn, each with the others' forces held
// (Gauss-Seidel on a convex problem: Theta is a Gram matrix), until no force changes. In
// three-point steps every other level is a separate chain, with a separate V.
#pragma once

#include <algorithm>
#include <cmath>

#include "schemes/contact/obstacle_rule.hpp"
#include "schemes/contact/solve_in_turn.hpp"

namespace jvari {

class RigidRule final : public ObstacleRule {
public:
    static constexpr bool conserves = true;

    RigidRule(std::span<const ContactLaw> laws, std::span<const double> theta, int levels)
        : ObstacleRule(laws, theta), stored_(laws.size()), levels_(levels) {}
    int dofs() const override { return levels_ * static_cast<int>(stored_.size()); }
    void begin(const double*, const double*) override {
        std::fill(stored_.begin(), stored_.end(), Levels{});
    }
    bool acts(const BeforeStep& at) const override {
        bool touching = false;
        for (std::size_t a = 0; a < stored_.size(); ++a)
            touching =
                touching || stored_[a].older > 0 || stored_[a].now > 0 || at.older[a] + at.b[a] > 0;
        return touching;
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept override;
    double potential(int a, double) const override {
        return levels_ == 1 ? stored_[a].older : 0.5 * (stored_[a].older + stored_[a].now);
    }

private:
    struct Levels {                 // V [J]
        double older = 0, now = 0;  // now: in three-point steps only
    };
    // force on a contact with the others' forces held in b
    double force_of(std::size_t a, double eta, double b) const {
        const double theta = theta_[a * stored_.size() + a], V = stored_[a].older;
        if (V <= 0) return std::max(0.0, (eta + b) / theta);
        const double root = std::sqrt(b * b + 4 * theta * V);  // r^2 + b r - theta V = 0
        return b > 0 ? 0.5 * (b + root) / theta : 2 * V / (root - b);
    }

    std::vector<Levels> stored_;
    int levels_;
};

inline GramSolution RigidRule::solve(const BeforeStep& at, double* r, double* force) noexcept {
    const GramSolution s =
        solve_in_turn(theta_, at.b, stored_.size(), r, force,
                      [&](std::size_t a, double b) { return force_of(a, at.older[a], b); });
    for (std::size_t a = 0; a < stored_.size(); ++a) {
        Levels& V = stored_[a];
        const double newer = V.older > 0 ? 0 : std::max(0.0, -force[a] * r[a]);
        V = levels_ == 1 ? Levels{newer, 0} : Levels{V.now, newer};
    }
    return s;
}

}  // namespace jvari
