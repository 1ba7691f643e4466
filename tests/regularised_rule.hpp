// A penalty whose force begins smoothly: V' of (eta + sqrt(eta^2 + s^2))/2 in place of max(eta, 0),
// s a millionth of the last step's way, so that no length depends on the unit. Made for a test: a
// rule is one file like this and one row of rules.hpp.
#pragma once

#include <cmath>

#include "schemes/contact/explicit_rule.hpp"

namespace jvari {

class RegularisedRule : public ExplicitRule {
public:
    RegularisedRule(std::span<const ContactLaw> laws, std::span<const double> theta, int levels)
        : ExplicitRule(laws, theta, levels), smooth_(laws.size()) {}
    bool acts(const BeforeStep&) const override { return !smooth_.empty(); }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept override {
        for (std::size_t a = 0; a < smooth_.size(); ++a) {
            const double eta = at.now[a], s = 1e-6 * std::abs(eta - at.older[a]);
            smooth_[a] = eta > -1e3 * s ? 0.5 * (eta + std::sqrt(eta * eta + s * s)) : 0;
        }
        return ExplicitRule::solve({at.older, smooth_.data(), at.b}, r, force);
    }

private:
    std::vector<double> smooth_;  // [m]
};

}  // namespace jvari
