// Penalty rule whose force over a step is a mean between its two ends, common in time integrators
// of finite-element programs:
//
//     F_a = (1 - share) V_a'(eta_a - r_a) + share V_a'(eta_a),   r = -b + Theta F
//
// share = 1/2 is the trapezoidal mean. No energy is balanced: if a contact opens or closes within a
// step, F r differs from the change in V. Leaves out: three-point steps.
#pragma once

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class EndForcesRule final : public ObstacleRule {
public:
    static constexpr bool conserves = false;

    EndForcesRule(std::span<const ContactLaw> laws, std::span<const double> theta, double share)
        : ObstacleRule(laws, theta), gram_(laws, theta, ContactGram::Force::of_the_ends, share) {}
    void set(std::span<const double> theta) noexcept override { gram_.set(theta); }
    void lose(std::span<const StepLoss> loss) override { gram_.lose(loss); }
    double lost() const override { return gram_.lost(); }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept override {
        return gram_.solve(at.older, at.b, r, force);
    }

private:
    ContactGram gram_;
};

}  // namespace jvari
