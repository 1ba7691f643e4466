// What an obstacle rule is: how the contacts' forces over one step are found. A new rule derives
// from this class and is a row of the table (rules.hpp).
//
// Over a step the readings of the contacts move by r = -b + Theta F: without forces by -b, and by
// the compliances Theta between them (van Walstijn et al. 2016, eq 48; Issanchou et al. 2016, eq
// 16). A rule says what F is, of the penetrations eta = h - y before the step and of r. What
// surrounds the contacts is not its affair: thread
// and what stands in series are in Theta and b when it is asked (obstacle.hpp).
//
// The invariant: where `conserves`, the work that the contacts do on the string is what their
// potential loses,
//
//     sum_a F_a r_a/levels = P(older) - P(newer),
//     P = sum_a potential(a, eta_a), levels = 1 in two-point steps, 2 in three-point ones
//
// less `lost()` [J] of the step, of a rule that has it or of contacts that do (StepLoss). Of this
// the energy balance of every scheme is made (van Walstijn et al. 2016, eqs 30, 49; Issanchou et
// al. 2016, eqs 20-21).
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

struct BeforeStep {       // of each contact
    const double* older;  // eta at the level that the step starts from [m]
    // at the level that it is centred on. Two-point steps have none there: the older one, or of a
    // rule that is `centred` the middle of the step as far as it is known without the contacts'
    // forces, eta + b/2
    const double* now;
    // minus the increment without contact forces, from the older to the newer level [m]
    const double* b;
};

// Without state, and acting where a contact is closed before the step or would be after it, unless
// a rule says else.
class ObstacleRule {
public:
    // theta: row-major between the contacts [m/N]
    ObstacleRule(std::span<const ContactLaw> laws, std::span<const double> theta)
        : laws_(laws.begin(), laws.end()), theta_(theta.begin(), theta.end()) {}
    virtual ~ObstacleRule() = default;

    virtual bool iterates() const { return true; }  // whether its iterations are reported
    virtual bool centred() const { return false; }  // how two-point steps fill `now`
    // of one contact without loss the closed form of one_contact.hpp
    virtual bool is_discrete_gradient() const { return false; }
    virtual int dofs() const { return 0; }  // state of its own
    // other compliances, coupled where the first ones were. Allocates nothing
    virtual void set(std::span<const double> theta) noexcept {
        std::copy(theta.begin(), theta.end(), theta_.begin());
    }
    // losses from now on, one of each contact, but of start()
    virtual void lose(std::span<const StepLoss>) {}
    // at t = 0: eta of each contact, and how far it would move in dt by its speed [m]
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
    // of a contact at a penetration [J]
    virtual double potential(int a, double eta) const { return laws_[a].potential(eta); }
    virtual double lost() const { return 0; }               // in the last step [J]
    virtual std::vector<Fact> facts() const { return {}; }  // beside those of obstacle.hpp

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

// levels: that a step spans
using MakeRule = std::function<std::shared_ptr<ObstacleRule>(
    std::span<const ContactLaw>, std::span<const double> theta, int levels)>;
struct RuleChoice {  // by which the contacts of a string act
    MakeRule make;
    MakeRule rigid = {};  // where the barriers do not give way
    // whether an equilibrium on contacts of an exponent other than 1 is one of the steps, and
    // stable
    bool rests_in_powers = true;
};

// What a rule's class says beside that: `conserves`; `Rigid`, the rule for barriers that do not
// give way; `own_only`, where nothing can stand in series with its contacts; `rests_in_powers`, as
// above; options, which it reads by choose(settings); features that it approximates, or leaves out.
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
