// The force of the level that the step is centred on, known before it: F_a = V_a'(eta_a). A
// conditionally stable control, which balances no energy. In two-point steps that level is the
// middle of the step, from where the string would move by itself: position Verlet, of second order.
// (The force of the older level would act half a step late and gain energy at any rate.)
#pragma once

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class ExplicitRule : public ObstacleRule {
public:
    static constexpr bool conserves = false, own_only = true;
    // in two-point steps it yields less by half of Theta under a steady force
    static constexpr Features leaves_out = Feature::equilibrium;

    ExplicitRule(std::span<const ContactLaw> laws, std::span<const double> theta, int)
        : ObstacleRule(laws, theta) {}
    bool iterates() const override { return false; }
    bool centred() const override { return true; }
    bool acts(const BeforeStep& at) const override {
        bool touching = false;
        for (std::size_t a = 0; a < laws_.size(); ++a) touching = touching || at.now[a] > 0;
        return touching;
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept override {
        for (std::size_t a = 0; a < laws_.size(); ++a) force[a] = laws_[a].force(at.now[a]);
        move(at.b, force, r);
        return {};
    }
};

}  // namespace jvari
