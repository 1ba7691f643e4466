// A penalty whose force begins smoothly: V' of (eta + sqrt(eta^2 + s^2))/2 in place of max(eta, 0), s = 1e-9 m, at the level that the step
// is centred on. Made for a test: a rule is one file like this and one row of rules.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class RegularisedRule {
public:
    static constexpr bool conserves = false, iterates = false, known_before = true;

    RegularisedRule(std::span<const ContactLaw> laws, std::span<const double> theta, int)
        : laws_(laws.begin(), laws.end()), theta_(theta.begin(), theta.end()) {}
    int dofs() const { return 0; }
    void set(std::span<const double> theta) noexcept { std::copy(theta.begin(), theta.end(), theta_.begin()); }
    void begin(const double*) {}
    bool acts(const BeforeStep&) const { return !laws_.empty(); }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept {
        const std::size_t n = laws_.size();
        for (std::size_t a = 0; a < n; ++a) force[a] = at.now[a] > -1e-6 ? laws_[a].force(smooth(at.now[a])) : 0;
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
    static double smooth(double eta) { return 0.5 * (eta + std::sqrt(eta * eta + 1e-18)); }
    std::vector<ContactLaw> laws_;
    std::vector<double> theta_;
};

}  // namespace jvari
