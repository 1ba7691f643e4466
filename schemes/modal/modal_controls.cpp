// Controls that promise no energy balance, on the string of three_point_modes.hpp by the driver. Only the contact or the gain is the
// control: the string is exact and the thread implicit, as in the schemes that they stand beside. Stored energy is the true one, so that
// what a scheme gains or loses is to be seen in the columns.
//
// modal_explicit_penalty   F_b^n = V'(eta^n): penalised_modes.hpp. Option `compliance` = own (default) | matched: what cut and step take
// from
//   the string's compliance in series.
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
// Leaves out: a stability limit of several contacts, contact loss with compliance=matched, polarisation, a body that moves.
#include <cmath>
#include <limits>

#include "schemes/contact/gradient_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/penalised_modes.hpp"
#include "schemes/run.hpp"

namespace jvari {

extern const Descriptor modal_explicit_penalty;

namespace {

using Made = std::unique_ptr<Scheme>;

Made made_explicit(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    matched_without_loss(descriptor, scene, settings);
    return penalised(descriptor, scene, settings, {});
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

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double margin_of_penalty(const Scene& scene, const Settings& settings) {
    return penalty_margin(modal_explicit_penalty, scene, settings, {});
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
                                                  .represents = modal_features_of_points | any_rigid,
                                                  .balance = Balance::none,
                                                  .clock = Clock::stepped,
                                                  .make = made_explicit,
                                                  .options = matched_options,
                                                  .approximates = modal_approximates,
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
