// Takes the force at the step's central level, known before the step: F_a = V_a'(eta_a). A
// conditionally stable control, which balances no energy. In two-point steps that level is the
// middle of the step, reached by the string's own motion: position Verlet, second order. (The force
// at the older level would act half a step late and gain energy at any rate.) With losses F_a =
// V_a'(eta_a) (1 - kappa_a r_a), which is linear in the step.
#pragma once

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class ExplicitRule : public ObstacleRule {
public:
    static constexpr bool conserves = false, own_only = true;
    // in two-point steps the contact yields less, by half of Theta, under a steady force
    static constexpr Features leaves_out = Feature::equilibrium;

    ExplicitRule(std::span<const ContactLaw> laws, std::span<const double> theta, int levels)
        : ObstacleRule(laws, theta), system_(laws.size()), levels_(levels) {}
    void lose(std::span<const StepLoss> loss) override {
        loss_.assign(loss.begin(), loss.end());
        for (auto* v : {&root_, &way_}) v->assign(loss.size(), 0.0);
        closed_.assign(loss.size(), 0);
    }
    bool iterates() const override { return false; }
    bool centred() const override { return true; }
    bool acts(const BeforeStep& at) const override {
        bool touching = false;
        for (std::size_t a = 0; a < laws_.size(); ++a) touching = touching || at.now[a] > 0;
        return touching;
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept override {
        const GramSolution s = start(at, r, force);
        return loss_.empty() ? s : lose_some(at, r, force);
    }
    GramSolution start(const BeforeStep& at, double* r, double* force) noexcept override {
        for (std::size_t a = 0; a < laws_.size(); ++a) force[a] = laws_[a].force(at.now[a]);
        move(at.b, force, r);
        lost_ = 0;
        return {};
    }
    double lost() const override { return lost_; }

private:
    // F = G - S S r with S^2 = kappa G, so that S r = (I + S Theta S)^-1 S (-b + Theta G)
    GramSolution lose_some(const BeforeStep& at, double* r, double* force) noexcept {
        int m = 0;
        for (std::size_t a = 0; a < laws_.size(); ++a) {
            root_[a] = std::sqrt(loss_[a].kappa * force[a]);
            if (root_[a] > 0) closed_[m++] = static_cast<int>(a);
        }
        if (!system_.factor(theta_.data(), static_cast<int>(laws_.size()), closed_.data(), m,
                            root_.data()))
            return {0, 0, false};
        for (int i = 0; i < m; ++i) way_[i] = root_[closed_[i]] * r[closed_[i]];
        system_.solve(way_.data());
        for (int i = 0; i < m; ++i) {
            force[closed_[i]] -= root_[closed_[i]] * way_[i];
            lost_ += way_[i] * way_[i] / levels_;
        }
        move(at.b, force, r);
        for (int i = 0; i < m; ++i) r[closed_[i]] = way_[i] / root_[closed_[i]];
        return {};
    }

    std::vector<StepLoss> loss_;      // none: nothing is lost
    std::vector<double> root_, way_;  // S; S r, by position in closed_
    std::vector<int> closed_;
    ScaledSystem system_;
    int levels_;
    double lost_ = 0;  // in the last step [J]
};

}  // namespace jvari
