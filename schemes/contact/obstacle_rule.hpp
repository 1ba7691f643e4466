// What an obstacle rule is: how the contacts' forces over one step are found. A new rule is a class
// of this kind and a row of the table.
//
// Over a step the readings of the contacts move by r = -b + Theta F: without forces by -b, and by
// the compliances Theta between them (van Walstijn et al. 2016, eq 48; Issanchou et al. 2016, eq
// 16). A rule says what F is, of the penetrations eta = h - y before the step and of r. What
// surrounds the contacts is not its affair: thread,
// contact loss and what stands in series are in Theta and b when it is asked (obstacle.hpp).
//
// The invariant: where `conserves`, the work that the contacts do on the string is what their
// potential loses,
//
//     sum_a F_a r_a/levels = P(older) - P(newer),     P = sum_a potential(a, eta_a), levels = 1 in
//     two-point steps, 2 in three-point ones
//
// less `lost()` [J] of the step, of a rule that has it. Of this the energy balance of every scheme
// is made (van Walstijn et al. 2016, eqs 30, 49; Issanchou et al. 2016, eqs 20-21).
#pragma once

#include <concepts>
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

template <class Rule>
concept ObstacleRule = requires(Rule rule, const Rule known, const BeforeStep& at,
                                std::span<const double> theta, std::span<const ContactLaw> laws,
                                double* out, const double* eta) {
    // theta: row-major between the contacts [m/N]; levels that a step spans
    Rule(laws, theta, 1);
    { Rule::conserves } -> std::convertible_to<bool>;  //
    { Rule::iterates } -> std::convertible_to<bool>;   // whether it tells of iterations
    { Rule::centred } -> std::convertible_to<bool>;    // how two-point steps fill `now`
    { known.dofs() } -> std::same_as<int>;             // state of its own
    // other compliances, coupled where the first ones were
    rule.set(theta);
    rule.begin(eta);  // at rest at t = 0
    // false: no force, and nothing to be solved
    { known.acts(at) } -> std::same_as<bool>;
    // r [m], and F on the string [N]. Allocates nothing
    { rule.solve(at, out, out) } -> std::same_as<GramSolution>;
    // of a contact at a penetration [J]
    { known.potential(1, 0.0) } -> std::same_as<double>;
    { known.facts() } -> std::same_as<std::vector<Fact>>;  // beside those of obstacle.hpp
};

// What most rules are: without state, with the laws and compliances that they were made with, and
// acting where a contact is closed before the step or would be after it.
struct PlainRule {
    static constexpr bool iterates = true, centred = false;
    PlainRule(std::span<const ContactLaw> laws, std::span<const double> theta)
        : laws_(laws.begin(), laws.end()), theta_(theta.begin(), theta.end()) {}
    int dofs() const { return 0; }
    void set(std::span<const double> theta) noexcept {
        std::copy(theta.begin(), theta.end(), theta_.begin());
    }
    void begin(const double*) {}
    bool acts(const BeforeStep& at) const {
        bool touching = false;
        for (std::size_t a = 0; a < laws_.size(); ++a)
            touching = touching || at.older[a] > 0 || at.older[a] + at.b[a] > 0;
        return touching;
    }
    double potential(int a, double eta) const { return laws_[a].potential(eta); }
    std::vector<Fact> facts() const { return {}; }

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

// What a rule may have beside that: start(at, r, force), the first half of a three-point step, from
// rest, with half of Theta, where that is not solve(); `Rigid`, the rule for barriers that do not
// give way; `own_only`, where nothing can stand in series with its contacts; options, which it
// reads by choose(settings); features that it approximates, or leaves out.
template <class Rule>
concept TakesRigid = requires {
    typename Rule::Rigid;
};
template <class Rule>
concept OwnOnly = requires {
    Rule::own_only;
};

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
