// Controls that promise no energy balance, on the string of three_point_modes.hpp by the driver. Only the contact or the gain is the
// control: the string is exact and the thread implicit, as in the schemes that they stand beside. Stored energy is the true one, so that
// what a scheme gains or loses is to be seen in the columns.
//
// modal_explicit_penalty   F_b^n = V'(eta^n) (contact/explicit_rule.hpp). Its limit is the stiffness of one lasting contact of exponent 1
//   at which the highest root passes z = -1. There y^{n+1} = -y^n. With G = sum g_p e_q/den (three_point_modes.hpp), den = 1 + C + C~,
//   contact b and thread c, which takes the mean of the outer levels, stand where
//
//       1/k_b > G_bb - k_c G_bc^2/(1 + k_c G_cc)
//
//   It is necessary and not sufficient: impacts gain energy below it too (C3 released without losses: still where the limit is 1.4 k, no
//   longer where it is 11 k). Of another exponent the contact is as stiff as V'' where it is deepest. That is nowhere deeper than where V
//   holds all that the string had at its start, so that stiffness bounds the critical step from below (Feng 2026, arXiv 2604.02533, of one
//   mass): in lasting contact the scheme is stable on this side of the line, and may be so beyond it. Of a pluck, whose work is not known
//   before, nothing is said.
//
// modal_impulse_invariant  the impulse-invariant transform of eq 17 in van Walstijn et al. 2016 (end of section 2.3): each mode has its own
//   gain e_i = dt R sin(omega dt)/(m omega); three-point discrete gradient for the contact. The paper rules it out since gains that
//   differ from mode to mode would admit no balance with non-negative energy. They do admit one: in place of m each mode takes dt^2/e_i,
//   which is positive below half the sample rate. Option `energy` = true (default) | adapted: with `adapted` the columns balance to
//   rounding, so no run can diverge. But a mode near half the sample rate hardly feels a force and keeps what it has as if it were
//   heavier by a = omega dt/(R sin omega dt): where an obstacle or a thread takes energy out of it into lower modes, more arrives than
//   left. True energy grows by up to a_j/a_1 - 1 after a start in mode j, by a_j mean(1/a) - 1 where all modes end with equal shares of
//   what is conserved; energy that goes the other way is lost by the same factor.
//
// Leaves out: a stability limit of several contacts, rigid barriers, compliance=matched, polarisation, a body that moves.
#include <cmath>
#include <limits>

#include "schemes/contact/explicit_rule.hpp"
#include "schemes/contact/gradient_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/three_point_modes.hpp"
#include "schemes/run.hpp"

namespace jvari {

extern const Descriptor modal_explicit_penalty;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Made = std::unique_ptr<Scheme>;

constexpr Option penalty_options[] = {profile_points_option};

class PenalisedModes : public ThreePointModes {
public:
    using ThreePointModes::ThreePointModes;
    double margin() const {  // of the contact's yield over the least that is stable, less 1; NaN unless there is one contact
        return points().contacts.count() == 1 ? 1 / stiffest() / least_yield() - 1 : nan;
    }
    std::vector<Fact> facts() const {
        std::vector<Fact> f = ThreePointModes::facts();
        if (points().contacts.count() == 1) f.push_back({facts::stable_stiffness_limit, 1 / least_yield()});
        return f;
    }

private:
    double least_yield() const {  // the limit's right side [m/N]
        const auto G = [this](int a, int b) {
            double sum = 0;
            for (int j = 0; j < p_.modes.count(); ++j)
                sum += p_.update.gain_of(j) * p_.update.ports[a].weights[j] * p_.update.ports[b].weights[j] /
                       (2 * (2 - p_.three_point.loss[j]) - p_.three_point.kappa[j]);
            return sum;
        };
        if (points().threads.empty()) return G(0, 0);
        const double k = points().threads.front().stiffness, G_bc = G(0, 1);
        return G(0, 0) - k * G_bc * G_bc / (1 + k * G(1, 1));
    }
    double stiffest() const {  // that the contact can be in this run [N/m]; NaN where that is not known
        const ContactLaw& law = points().contacts.laws[0];
        if (law.alpha == 1) return law.k;
        if (points().pluck) return nan;
        double E = 0;
        for (int j = 0; j < p_.modes.count(); ++j) {
            const double w = p_.modes.omega0[j] * p_.initial[j];
            E += 0.5 * p_.modes.mass * w * w;
        }
        return law.slope(std::pow((law.alpha + 1) * E / law.k, 1 / (law.alpha + 1)));
    }
};

Made made_explicit(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    return driven<ExplicitRule>(std::make_unique<PenalisedModes>(problem_of_modes(descriptor, scene, settings)), descriptor, settings);
}

constexpr Option energy_option{
    "energy", "true", "what the energy columns hold: the true energy, or the one that the scheme conserves", {"true", "adapted"}};
constexpr Option impulse_invariant_options[] = {energy_option, profile_points_option};

Made made_impulse_invariant(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    const ModalGain gain{impulse_gain, choice_option(settings, energy_option) == "adapted"};
    return std::make_unique<Driver<ThreePointModes, GradientRule>>(
        std::make_unique<ThreePointModes>(problem_of_modes(descriptor, scene, settings, gain)), steps_per_row(settings));
}

// ---- Limits that are known.

double margin_of_penalty(const Scene& scene, const Settings& settings) try {
    return PenalisedModes(problem_of_modes(modal_explicit_penalty, scene, settings)).margin();
} catch (const Refusal&) {
    return nan;
}

// With a_i = omega dt/sin(omega dt) the scheme conserves sum a_i E_i, E_i true. All of E in mode j and a_i E_i then the same on average for
// all i is E (a_j mean(1/a_i) - 1) more than there was. No mode near its limit is left out: modes above half the rate are refused.
double shares_margin(const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    const auto* start = s.initial ? std::get_if<ModeInitial>(&*s.initial) : nullptr;
    if (!start || !std::holds_alternative<NoDamping>(s.damping)) return nan;
    const Modes modes = modes_of(s, modes_for(s, settings));
    if (start->number > modes.count()) return nan;
    const auto share = [&](int i) {  // 1/a_i
        const double h = modes.omega0[i] / settings.sample_rate;
        return std::sin(h) / h;
    };
    double mean = 0;
    for (int i = 0; i < modes.count(); ++i) mean += share(i) / modes.count();
    return gain_allowed_unpromised - (mean / share(start->number - 1) - 1);
}
}  // namespace

extern const Descriptor modal_explicit_penalty = {.name = "modal_explicit_penalty",
                                                  .source = "exact modes, contact force of the last step (conditionally stable control)",
                                                  .represents = modal_features_of_points,
                                                  .balance = Balance::none,
                                                  .clock = Clock::stepped,
                                                  .make = made_explicit,
                                                  .options = penalty_options,
                                                  .approximates = modal_approximates_elastic,
                                                  .limit = {"penalty_limit", margin_of_penalty}};
extern const Descriptor modal_impulse_invariant = {
    .name = "modal_impulse_invariant",
    .source = "van Walstijn et al. 2016, end of section 2.3: gains that differ from mode to mode (control)",
    .represents = modal_features_of_points,
    .balance = Balance::none,
    .clock = Clock::stepped,
    .make = made_impulse_invariant,
    .options = impulse_invariant_options,
    .approximates = modal_approximates_elastic,
    .limit = {"equal_shares", shares_margin}};

}  // namespace jvari
