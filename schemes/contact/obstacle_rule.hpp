// Interface of an obstacle rule, which finds the contact forces over one step. A new rule derives
// from this class and is a row in the table (rules.hpp).
//
// Over a step the readings of the contacts move by r = -b + Theta F: without forces by -b, and by
// the compliances Theta between them (van Walstijn et al. 2016, eq 48; Issanchou et al. 2016, eq
// 16). A rule determines F from the penetrations eta = h - y before the step and from r. The rule
// does not see the surroundings of the contacts: thread and series compliance are already contained
// in Theta and b (obstacle.hpp).
//
// The invariant: if `conserves`, the work done on the string by the contacts equals the loss in
// their potential,
//
//     sum_a F_a r_a/levels = P(older) - P(newer),
//     P = sum_a potential(a, eta_a), levels = 1 in two-point steps, 2 in three-point ones
//
// minus `lost()` [J] in the step, for a lossy rule or for lossy contacts (StepLoss). The energy
// balance of every scheme rests on this (van Walstijn et al. 2016, eqs 30, 49; Issanchou et al.
// 2016, eqs 20-21).
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "schemes/contact/contact_gram.hpp"
#include "schemes/facts.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

struct BeforeStep {       // values for each contact
    const double* older;  // eta at the level from which the step starts [m]
    // eta at the central level. Two-point steps have no central level and use the older one. A rule
    // that is `centred` uses the middle of the step without contact forces, eta + b/2
    const double* now;
    // minus the increment without contact forces, from the older to the newer level [m]
    const double* b;
};

// Stateless by default. Acts if a contact is closed before the step or would be closed after it,
// unless a rule overrides this.
class ObstacleRule {
public:
    // theta: row-major between the contacts [m/N]
    ObstacleRule(std::span<const ContactLaw> laws, std::span<const double> theta)
        : laws_(laws.begin(), laws.end()), theta_(theta.begin(), theta.end()) {}
    virtual ~ObstacleRule() = default;

    virtual bool iterates() const { return true; }  // true if its iterations are reported
    virtual bool centred() const { return false; }  // how two-point steps fill `now`
    // true if a lossless contact has the closed form of ContactAndThread (eliminated_thread.hpp)
    virtual bool is_discrete_gradient() const { return false; }
    virtual int dofs() const { return 0; }  // number of state variables
    // Sets other compliances with the same coupling pattern. Allocates nothing.
    virtual void set(std::span<const double> theta) noexcept {
        std::copy(theta.begin(), theta.end(), theta_.begin());
    }
    // Sets the losses from this step on, one for each contact; start() has none.
    virtual void lose(std::span<const StepLoss>) {}
    // at t = 0: eta for each contact, and the distance that its speed would move it in dt [m]
    virtual void begin(const double*, const double*) {}
    // false: no force, and nothing to be solved
    virtual bool acts(const BeforeStep& at) const {
        bool touching = false;
        for (std::size_t a = 0; a < laws_.size(); ++a)
            touching = touching || at.older[a] > 0 || at.older[a] + at.b[a] > 0;
        return touching;
    }
    // r [m], and F on the string [N]. Allocates nothing
    virtual GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept = 0;
    // the first half of a three-point step, from rest, with half of Theta
    virtual GramSolution start(const BeforeStep& at, double* r, double* force) noexcept {
        return solve(at, r, force);
    }
    // energy of a contact at a penetration [J]
    virtual double potential(int a, double eta) const { return laws_[a].potential(eta); }
    virtual double lost() const { return 0; }  // in the last step [J]
    // in addition to the facts in obstacle.hpp
    virtual std::vector<Fact> facts() const { return {}; }

protected:
    void move(const double* b, const double* force, double* r) const noexcept {  // r = -b + Theta F
        const std::size_t n = laws_.size();
        for (std::size_t a = 0; a < n; ++a) {
            r[a] = -b[a];
            for (std::size_t c = 0; c < n; ++c) r[a] += theta_[a * n + c] * force[c];
        }
    }
    std::vector<ContactLaw> laws_;
    std::vector<double> theta_;
};

// levels: number of levels that a step spans
using MakeRule = std::function<std::shared_ptr<ObstacleRule>(
    std::span<const ContactLaw>, std::span<const double> theta, int levels)>;
struct RuleChoice {  // the rule for the contacts on a string
    MakeRule make;
    MakeRule rigid = {};  // for barriers that do not give way
    // true if an equilibrium on contacts with an exponent other than 1 is a fixed point of the
    // steps, and stable
    bool rests_in_powers = true;
};

// Further static members of a rule's class: `conserves`; `Rigid`, the rule for barriers that do not
// give way; `own_only`, if nothing can stand in series with its contacts; `rests_in_powers`, see
// above; options, which the rule reads by choose(settings); features that it approximates, or
// leaves out.
template <class Rule>
concept TakesRigid = requires {
    typename Rule::Rigid;
};
template <class Rule>
concept OwnOnly = requires {
    Rule::own_only;
};

template <class Rule>
MakeRule rule_with(const Settings& settings) {
    return [settings](std::span<const ContactLaw> laws, std::span<const double> theta, int levels) {
        auto rule = std::make_unique<Rule>(laws, theta, levels);
        if constexpr (requires { rule->choose(settings); }) rule->choose(settings);
        return rule;
    };
}
template <class Rule>
RuleChoice rule_of(const Settings& settings) {
    RuleChoice choice{rule_with<Rule>(settings)};
    if constexpr (TakesRigid<Rule>) choice.rigid = rule_with<typename Rule::Rigid>(settings);
    if constexpr (requires { Rule::rests_in_powers; })
        choice.rests_in_powers = Rule::rests_in_powers;
    return choice;
}

template <class Rule>
constexpr std::span<const Option> options_of() {
    if constexpr (requires { Rule::options; }) return Rule::options;
    else return {};
}
template <class Rule>
constexpr std::span<const Approximation> approximations_of() {
    if constexpr (requires { Rule::approximates; }) return Rule::approximates;
    else return {};
}
template <class Rule>
constexpr Features left_out_by() {
    Features none;
    if constexpr (requires { Rule::leaves_out; }) none = none | Rule::leaves_out;
    if constexpr (!TakesRigid<Rule>) none = none | any_rigid;
    return none;
}

}  // namespace jvari
