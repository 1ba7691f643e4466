// Controls that promise no energy balance, on the three-point recursion of modal_three_point.hpp. Only the contact or the gain is the
// control: the string is exact and the thread implicit, as in the schemes that they stand beside. Stored energy is the true one,
//     sum m (den d^2 + num s^2)/(8 dt^2) + V_c + (V(eta^{n+1}) + V(eta^n))/2,
// so that what a scheme gains or loses is to be seen in the columns.
//
// modal_explicit_penalty   F_b^n = V'(eta^n). With exponent 1 stable in lasting contact only below
//     k_max = m/(dt^2 sum g^2/den),  den = 1 + C + C~ = 4 cos^2(omega dt/2) without losses,
//   the stiffness at which the highest root passes z = -1: 4 m/(dt^2 sum g^2) where the modes are far below half the sample rate. The
//   thread adds its compliance (Sherman-Morrison). Fact `stable_stiffness_limit`. It is the limit of lasting contact, necessary and not
//   sufficient: impacts gain energy below it too (C3 released without losses: still where the limit is 1.4 k, no longer where it is 11 k).
//   Option `compliance` = own (default) | matched: what cut and step take from the string's compliance in series (series_force.hpp).
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
// Both are the string of three_point_modes.hpp by the driver, explicit_rule.hpp or gradient_rule.hpp. Leaves out: a stability limit of
// several contacts, compliance=matched with them, polarisation, a body that moves.
#include <cmath>
#include <limits>

#include "schemes/contact/compliance.hpp"
#include "schemes/contact/explicit_rule.hpp"
#include "schemes/contact/gradient_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/series_force.hpp"
#include "schemes/modal/three_point_modes.hpp"
#include "schemes/run.hpp"

namespace jvari {

extern const Descriptor modal_explicit_penalty;

namespace {

double stiffness_limit(const ModalString& m) {
    double bb = 0, bc = 0, cc = 0;
    for (int i = 0; i < m.count; ++i) {
        const double b = m.g_b.empty() ? 0 : m.g_b[i], c = m.g_c.empty() ? 0 : m.g_c[i];
        bb += b * b / m.den[i];
        bc += b * c / m.den[i];
        cc += c * c / m.den[i];
    }
    const double kappa_c = m.k_c * m.dt * m.dt / m.mass;  // at z = -1 the thread is its spring alone
    return m.mass / (m.dt * m.dt * (bb - kappa_c * bc * bc / (1 + kappa_c * cc)));
}

using Made = std::unique_ptr<Scheme>;

// The string of the control, and beside its own facts the limit of one contact that is known.
class Penalised : public ThreePointModes {
public:
    Penalised(const Descriptor& descriptor, const Scene& scene, const Settings& settings)
        : ThreePointModes(descriptor, scene, settings, plain_gain, modal_mass) {
        if (points().contacts.count() == 1) limit_ = stiffness_limit(modal_string(descriptor, scene, settings));
    }
    std::vector<Fact> facts() const {
        std::vector<Fact> f = ThreePointModes::facts();
        if (limit_ > 0) f.push_back({facts::stable_stiffness_limit, limit_});
        return f;
    }

private:
    double limit_ = 0;  // [N/m]
};

Made made_explicit(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    if (choice_option(settings, compliance_option) == "matched") {
        if (!touches_once_without_loss(scene.strings.front())) refuse_matched_points(descriptor, settings);
        ModalString string = modal_string(descriptor, scene, settings);
        const ModalArray gain = ThreePointModes::plain_gain(string);
        return explicit_in_series(descriptor, scene, std::move(string), gain);
    }
    return std::make_unique<Driver<Penalised, ExplicitRule>>(std::make_unique<Penalised>(descriptor, scene, settings),
                                                             steps_per_row(settings));
}

constexpr Option energy_option{
    "energy", "true", "what the energy columns hold: the true energy, or the one that the scheme conserves", {"true", "adapted"}};
constexpr Option explicit_options[] = {compliance_option, profile_points_option};
constexpr Option impulse_invariant_options[] = {energy_option, profile_points_option};

ModalArray adapted_inertia(const ModalString& string, const ModalArray& gain) {
    ModalArray inertia(string.count);
    for (int i = 0; i < string.count; ++i) inertia[i] = string.dt * string.dt / gain[i];
    return inertia;
}

Made made_impulse_invariant(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    const auto inertia = choice_option(settings, energy_option) == "true" ? ThreePointModes::modal_mass : adapted_inertia;
    return std::make_unique<Driver<ThreePointModes, GradientRule>>(
        std::make_unique<ThreePointModes>(descriptor, scene, settings, impulse_gain, inertia), steps_per_row(settings));
}

// ---- Limits that are known.

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// det of the string's recursion with the springs k g g' at z = -1, by the compliances there: den = 1 + C + C~ of each mode, with
// C = 2 R cos(omega dt), C~ = R^2. The thread is its spring alone: its damper acts on y^{n+1} - y^{n-1} = 0.
double penalty_margin(const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    if (s.barriers.size() != 1) return nan;
    const auto* barrier = std::get_if<LumpedBarrier>(&s.barriers.front());
    if (!barrier || barrier->exponent != 1) return nan;
    if (choice_option(settings, compliance_option) == "matched")
        return series_margin(modal_explicit_penalty, scene, settings, ThreePointModes::plain_gain);
    const double dt = 1 / settings.sample_rate;
    const Modes modes = modes_of(s, modes_for(s, settings));
    const auto g = footprint_weights(modes, barrier->position, barrier->width);
    const auto c = s.thread ? footprint_weights(modes, s.thread->position, s.thread->width) : std::vector<double>(g.size(), 0.0);
    double gg = 0, gc = 0, cc = 0;  // compliances [m/N]
    for (int i = 0; i < modes.count(); ++i) {
        const double R = std::exp(-modes.sigma[i] * dt), w = std::sqrt(omega_squared_damped(modes.omega0[i], modes.sigma[i]));
        const double compliance = dt * dt / (modes.mass * (1 + 2 * R * std::cos(w * dt) + R * R));
        gg += compliance * g[i] * g[i];
        gc += compliance * g[i] * c[i];
        cc += compliance * c[i] * c[i];
    }
    const double k = s.thread ? s.thread->stiffness : 0;
    return 1 / (gg - k * gc * gc / (1 + k * cc)) / barrier->stiffness.k - 1;
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

constexpr Features of_several_points =
    modal_features | Features(Feature::profile_barrier) | Features(Feature::several_barriers) | Features(Feature::contact_loss);
constexpr Approximation approximates[] = {{Feature::profile_barrier, facts::contact_points}};

extern const Descriptor modal_explicit_penalty = {.name = "modal_explicit_penalty",
                                                  .source = "exact modes, contact force of the last step (conditionally stable control)",
                                                  .represents = of_several_points,
                                                  .balance = Balance::none,
                                                  .clock = Clock::stepped,
                                                  .make = made_explicit,
                                                  .options = explicit_options,
                                                  .approximates = approximates,
                                                  .limit = {"penalty_limit", penalty_margin}};
extern const Descriptor modal_impulse_invariant = {
    .name = "modal_impulse_invariant",
    .source = "van Walstijn et al. 2016, end of section 2.3: gains that differ from mode to mode (control)",
    .represents = of_several_points,
    .balance = Balance::none,
    .clock = Clock::stepped,
    .make = made_impulse_invariant,
    .options = impulse_invariant_options,
    .approximates = approximates,
    .limit = {"equal_shares", shares_margin}};

}  // namespace jvari
