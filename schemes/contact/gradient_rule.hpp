// Discrete gradient of each contact's potential over the step. The potential loses exactly the work
// done by the contact on the string:
//
//     F_a(r_a) = -[V_a(eta_a - r_a) - V_a(eta_a)]/r_a >= 0
//
// and with a loss 1 - kappa_a r_a times that, of the second order as well (StepLoss). Two-point
// steps: van Walstijn, Bridges & Mehes 2016, eqs 30 and 48; three-point: Issanchou et al. 2016, eq
// 16. One contact has a closed form with exponent 1 (contact.hpp), several that Theta couples take
// Newton steps (contact_gram.hpp).
#pragma once

#include "schemes/contact/rigid_rule.hpp"

namespace jvari {

class GradientRule final : public ObstacleRule {
public:
    static constexpr bool conserves = true;
    using Rigid = RigidRule;

    GradientRule(std::span<const ContactLaw> laws, std::span<const double> theta, int levels)
        : ObstacleRule(laws, theta), gram_(laws, theta), levels_(levels) {}
    bool is_discrete_gradient() const override { return true; }
    void set(std::span<const double> theta) noexcept override { gram_.set(theta); }
    void lose(std::span<const StepLoss> loss) override {
        gram_.lose(loss);
        losing_ = true;
    }
    GramSolution start(const BeforeStep& at, double* r, double* force) noexcept override {
        return gram_.solve(at.older, at.b, r, force, true);
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept override {
        if (laws_.size() != 1 || losing_) return gram_.solve(at.older, at.b, r, force);
        const ContactSolution s = solve_contact(laws_[0], at.older[0], at.b[0], gram_.theta()[0]);
        *r = s.r;
        *force = s.force;
        return {s.iterations, s.residual, s.converged};
    }
    double lost() const override { return gram_.lost() / levels_; }
    std::vector<Fact> facts() const override {
        if (gram_.coupled() <= 1) return {};
        return {{facts::coupled_contact_points, static_cast<double>(gram_.coupled())}};
    }

private:
    ContactGram gram_;
    int levels_;
    bool losing_ = false;
};

}  // namespace jvari
