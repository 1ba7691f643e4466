// Moreau-Jean time stepping: Newton's law of impact with a coefficient of restitution e (Moreau
// 1988; Jean 1999; for a string in its modes: Issanchou, Acary, Perignon, Touze & Le Carrou 2018).
// Barriers are rigid, whatever stiffness and exponent they have.
//
// A contact is active if its gap would close within half a step at its present speed v, and then
//     0 <= F,   0 <= v+ + e v,   F (v+ + e v) = 0;       v, v+ the speeds before and after the step
// In three-point steps v = (y^n - y^{n-1})/dt and v+ = (y^{n+1} - y^n)/dt. A two-point step moves
// by dt (v + v+)/2, so v+ = 2 r/dt - v. With w = v dt or v dt/2, r = w + w+ either way, and the law
// is 0 <= F, r >= (1 - e) w. The loss is -F r/levels: nothing if e = 1. If e < 1 the published law
// gives a little energy to an active contact that moves away, w > 0. No energy is stored. Option
// `restitution` = e, 0 to 1 (1).
#pragma once

#include "schemes/contact/obstacle_rule.hpp"
#include "schemes/contact/solve_in_turn.hpp"
#include "schemes/making.hpp"

namespace jvari {

inline constexpr Option restitution_option{"restitution", "1",
                                           "coefficient of restitution e, 0 to 1"};

class MoreauJeanRule final : public ObstacleRule {
public:
    static constexpr bool conserves = false;
    static constexpr Option options[] = {restitution_option};
    static constexpr Approximation approximates[] = {
        {Feature::lumped_barrier, facts::rigid_barrier},
        {Feature::profile_barrier, facts::rigid_barrier},
        {Feature::power_law_contact, facts::rigid_barrier},
        {Feature::rigid_barrier, facts::rigid_barrier},
        // beside one that gives way
        {Feature::rigid_profile, facts::rigid_barrier}};
    static constexpr Features leaves_out = Feature::contact_loss | Feature::equilibrium;
    using Rigid = MoreauJeanRule;

    MoreauJeanRule(std::span<const ContactLaw> laws, std::span<const double> theta, int levels)
        : ObstacleRule(laws, theta), w_(laws.size(), 0.0), levels_(levels) {}
    void choose(const Settings& settings) {
        e_ = number_option(settings, restitution_option);
        if (!(e_ >= 0 && e_ <= 1))
            throw Refusal("option restitution: expected a number from 0 to 1");
    }
    int dofs() const override { return levels_ == 1 ? static_cast<int>(w_.size()) : 0; }
    void begin(const double*, const double* moving) override {
        for (std::size_t a = 0; a < w_.size(); ++a) w_[a] = levels_ == 1 ? 0.5 * moving[a] : 0;
        lost_ = 0;
    }
    // the rule follows the speed
    bool acts(const BeforeStep&) const override { return !w_.empty(); }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept override;
    // from rest: y^{-1} = y^1, a two-point step
    GramSolution start(const BeforeStep& at, double* r, double* force) noexcept override {
        return impact(at, r, force, [&](std::size_t a) { return -at.older[a]; });
    }
    double potential(int, double) const override { return 0; }
    double lost() const override { return lost_; }
    std::vector<Fact> facts() const override { return {{facts::rigid_barrier, 1}}; }

private:
    template <class Gap>
    GramSolution impact(const BeforeStep& at, double* r, double* force, Gap gap) noexcept {
        const double half = levels_ == 1 ? 1 : 0.5;
        const GramSolution s =
            solve_in_turn(theta_, at.b, w_.size(), r, force, [&](std::size_t a, double b) {
                const bool active = gap(a) + half * w_[a] <= 0;
                return active ? std::max(0.0, ((1 - e_) * w_[a] + b) / theta_[a * w_.size() + a])
                              : 0.0;
            });
        lost_ = 0;
        for (std::size_t a = 0; a < w_.size(); ++a) {
            lost_ -= force[a] * r[a] / levels_;
            w_[a] = r[a] - w_[a];
        }
        return s;
    }

    std::vector<double> w_;  // v dt/2 in two-point steps, v dt in three-point ones [m]
    int levels_;
    double e_ = 1, lost_ = 0;
};

inline GramSolution MoreauJeanRule::solve(const BeforeStep& at, double* r, double* force) noexcept {
    if (levels_ == 1) return impact(at, r, force, [&](std::size_t a) { return -at.older[a]; });
    for (std::size_t a = 0; a < w_.size(); ++a) w_[a] = at.older[a] - at.now[a];
    return impact(at, r, force, [&](std::size_t a) { return -at.now[a]; });
}

}  // namespace jvari
