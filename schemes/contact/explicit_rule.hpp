// The force of the level that the step is centred on, known before it: F_a = V_a'(eta_a^n). A conditionally stable control, which balances
// no energy. In two-point steps that level is the older one.
#pragma once

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class ExplicitRule {
public:
    static constexpr bool conserves = false, iterates = false, known_before = true;

    ExplicitRule(std::span<const ContactLaw> laws, std::span<const double> theta, int)
        : laws_(laws.begin(), laws.end()), theta_(theta.begin(), theta.end()) {}
    int dofs() const { return 0; }
    void set(std::span<const double> theta) noexcept { std::copy(theta.begin(), theta.end(), theta_.begin()); }
    void begin(const double*) {}
    bool acts(const BeforeStep& at) const {
        bool touching = false;
        for (std::size_t a = 0; a < laws_.size(); ++a) touching = touching || at.now[a] > 0;
        return touching;
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept {
        const std::size_t n = laws_.size();
        for (std::size_t a = 0; a < n; ++a) force[a] = laws_[a].force(at.now[a]);
        for (std::size_t a = 0; a < n; ++a) {
            r[a] = -at.b[a];
            for (std::size_t c = 0; c < n; ++c) r[a] += theta_[a * n + c] * force[c];
        }
        return {};
    }
    GramSolution start(const BeforeStep& at, double* r, double* force) noexcept { return solve(at, r, force); }
    double potential(int a, double eta) const { return laws_[a].potential(eta); }
    std::vector<Fact> facts() const { return {}; }

private:
    std::vector<ContactLaw> laws_;
    std::vector<double> theta_;
};

}  // namespace jvari
