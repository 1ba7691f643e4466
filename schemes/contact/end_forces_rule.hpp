// A penalty whose force over a step is a mean of those at its two ends, as time integrators of finite-element programs take it:
//
//     F_a = (1 - share) V_a'(eta_a - r_a) + share V_a'(eta_a),   r = -b + Theta F
//
// share = 1/2 is the trapezoidal mean. No energy is balanced: where a contact opens or closes within a step, F r is not what V changes by.
// The forces at the new end are those of contacts behind (1 - share) Theta (contact_gram.hpp). Leaves out: three-point steps.
#pragma once

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class EndForcesRule {
public:
    static constexpr bool conserves = false, iterates = true, centred = false;

    EndForcesRule(std::span<const ContactLaw> laws, std::span<const double> theta, int)
        : laws_(laws.begin(), laws.end()), theta_(theta.begin(), theta.end()), b_(laws.size()), old_(laws.size()) {
        take_share(0.5);
    }
    void take_share(double share) {
        share_ = share;
        std::vector<double> part = theta_;
        for (double& x : part) x *= 1 - share_;
        gram_ = ContactGram(laws_, part, ContactGram::Force::at_the_end);
        part_ = std::move(part);
    }
    int dofs() const { return 0; }
    void set(std::span<const double> theta) noexcept {
        for (std::size_t i = 0; i < theta_.size(); ++i) {
            theta_[i] = theta[i];
            part_[i] = (1 - share_) * theta[i];
        }
        gram_.set(part_);
    }
    void begin(const double*) {}
    bool acts(const BeforeStep& at) const {
        bool touching = false;
        for (std::size_t a = 0; a < laws_.size(); ++a) touching = touching || at.older[a] > 0 || at.older[a] + at.b[a] > 0;
        return touching;
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept {
        const std::size_t n = laws_.size();
        for (std::size_t a = 0; a < n; ++a) old_[a] = share_ * laws_[a].force(at.older[a]);
        for (std::size_t a = 0; a < n; ++a) {
            b_[a] = at.b[a];
            for (std::size_t c = 0; c < n; ++c) b_[a] -= theta_[a * n + c] * old_[c];
        }
        const GramSolution s = gram_.solve(at.older, b_.data(), r, force);
        for (std::size_t a = 0; a < n; ++a) force[a] = (1 - share_) * force[a] + old_[a];
        return s;
    }
    GramSolution start(const BeforeStep& at, double* r, double* force) noexcept { return solve(at, r, force); }
    double potential(int a, double eta) const { return laws_[a].potential(eta); }
    std::vector<Fact> facts() const { return {}; }

private:
    std::vector<ContactLaw> laws_;
    std::vector<double> theta_, part_;  // part_: (1 - share) Theta
    ContactGram gram_;
    double share_ = 0.5;
    std::vector<double> b_, old_;  // old_: the older level's part of the force [N]
};

}  // namespace jvari
