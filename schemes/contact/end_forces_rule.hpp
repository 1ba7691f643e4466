// A penalty whose force over a step is a mean of those at its two ends, as time integrators of
// finite-element programs take it:
//
//     F_a = (1 - share) V_a'(eta_a - r_a) + share V_a'(eta_a),   r = -b + Theta F
//
// share = 1/2 is the trapezoidal mean. No energy is balanced: where a contact opens or closes
// within a step, F r is not what V changes by. The forces at the new end are those of contacts
// behind (1 - share) Theta (contact_gram.hpp). Leaves out: three-point steps.
#pragma once

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class EndForcesRule final : public ObstacleRule {
public:
    static constexpr bool conserves = false;

    EndForcesRule(std::span<const ContactLaw> laws, std::span<const double> theta, double share)
        : ObstacleRule(laws, theta),
          part_(theta_),
          share_(share),
          b_(laws.size()),
          old_(laws.size()) {
        for (double& x : part_) x *= 1 - share_;
        gram_ = ContactGram(laws_, part_, ContactGram::Force::at_the_end);
    }
    void set(std::span<const double> theta) noexcept override {
        for (std::size_t i = 0; i < theta_.size(); ++i) {
            theta_[i] = theta[i];
            part_[i] = (1 - share_) * theta[i];
        }
        gram_.set(part_);
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept override {
        const std::size_t n = laws_.size();
        for (std::size_t a = 0; a < n; ++a) old_[a] = share_ * laws_[a].force(at.older[a]);
        move(at.b, old_.data(), b_.data());
        for (double& b : b_) b = -b;
        const GramSolution s = gram_.solve(at.older, b_.data(), r, force);
        for (std::size_t a = 0; a < n; ++a) force[a] = (1 - share_) * force[a] + old_[a];
        return s;
    }

private:
    std::vector<double> part_;  // (1 - share) Theta
    ContactGram gram_;
    double share_;
    std::vector<double> b_, old_;  // old_: the older level's part of the force [N]
};

}  // namespace jvari
