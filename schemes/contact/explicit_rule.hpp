// The force of the level that the step is centred on, known before it: F_a = V_a'(eta_a). A conditionally stable control, which balances no
// energy. In two-point steps that level is the middle of the step, from where the string would move by itself: position Verlet, of second
// order. (The force of the older level would act half a step late and gain energy at any rate.)
// With a compliance in series (obstacle.hpp) its yield is no part of what is known before: F_a = V_a'(eta_a - (S F)_a), S [m/N] what the
// compliance alone yields up to the middle of the step. A rigid barrier is met by S alone: 0 <= F, 0 <= (S F)_a - eta_a, F_a [...] = 0.
#pragma once

#include <optional>

#include "schemes/contact/rigid_rule.hpp"

namespace jvari {

class ExplicitRule : public PlainRule {
public:
    static constexpr bool conserves = false, iterates = false, centred = true, rigid_in_series_only = true;
    using Rigid = ExplicitRule;

    ExplicitRule(std::span<const ContactLaw> laws, std::span<const double> theta, int) : PlainRule(laws, theta) {}
    void put_in_series(std::span<const double> S) {  // row-major between the contacts
        yielding_ = ContactGram(laws_, S, ContactGram::Force::at_the_end);
        if (!laws_.empty() && laws_.front().rigid()) rigid_.emplace(laws_, S, 1);
        none_.assign(laws_.size(), 0.0);
    }
    bool acts(const BeforeStep& at) const {
        bool touching = false;
        for (std::size_t a = 0; a < laws_.size(); ++a) touching = touching || at.now[a] > 0;
        return touching;
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept {
        const std::size_t n = laws_.size();
        if (!none_.empty()) {
            const GramSolution s =
                rigid_ ? rigid_->solve({at.now, at.now, none_.data()}, r, force) : yielding_.solve(at.now, none_.data(), r, force);
            for (std::size_t a = 0; a < n; ++a) r[a] += at.older[a] - at.now[a];  // to where it touches
            return s;
        }
        for (std::size_t a = 0; a < n; ++a) force[a] = laws_[a].force(at.now[a]);
        move(at.b, force, r);
        return {};
    }
    double potential(int a, double eta) const { return rigid_ ? 0 : laws_[a].potential(eta); }

private:
    ContactGram yielding_;
    std::optional<RigidRule> rigid_;
    std::vector<double> none_;  // of nothing in series
};

}  // namespace jvari
