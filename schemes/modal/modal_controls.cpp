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
// One lumped barrier without contact loss goes through the kernels of modal_three_point.hpp. Several, profiles by points (option `points`)
// and contact loss go through modal_three_point_points.hpp: F^n = V'(eta^n) less beta V'(eta^n) (y^{n+1} - y^{n-1})/(2 dt), whose
// resistance is solved for; or the coupled discrete gradients of obstacle_step.hpp, which conserve the adapted energy as one does. Leaves
// out: a stability limit of several contacts, compliance=matched with them, polarisation, a body that moves.
#include <cmath>
#include <limits>

#include "schemes/contact/compliance.hpp"
#include "schemes/contact/explicit_points.hpp"
#include "schemes/contact/obstacle_step.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_three_point.hpp"
#include "schemes/modal/modal_three_point_points.hpp"
#include "schemes/modal/modal_two_point_points.hpp"
#include "schemes/modal/series_force.hpp"
#include "schemes/run.hpp"

namespace jvari {

extern const Descriptor modal_explicit_penalty;

namespace {

struct TrueEnergyContact {  // what both have in common
    static constexpr int dofs = 0;
    ContactLaw law;
    ForceRange range;
    double depth = 0, force = 0;

    void begin(double) {}
    bool solved() const { return true; }
    void settle(double eta, double) {
        range.note(force);
        depth = std::max(depth, eta);
    }
    double energy(double eta, double eta_old) const { return 0.5 * (law.potential(eta) + law.potential(eta_old)); }
    double energy_next(double eta, double eta_old) const { return energy(eta, eta_old); }
    std::vector<Fact> facts() const {
        return {
            {facts::smallest_contact_force, range.least}, {facts::largest_contact_force, range.most}, {facts::deepest_penetration, depth}};
    }
};

struct ExplicitContact : TrueEnergyContact {
    double limit = 0;  // [N/m]
    double first(double eta, double, double) { return force = 0.5 * law.force(eta); }
    double next(double eta, double, double, double) { return force = law.force(eta); }
    std::vector<Fact> facts() const {
        auto f = TrueEnergyContact::facts();
        f.push_back({facts::stable_stiffness_limit, limit});
        return f;
    }
};

struct GradientContact : TrueEnergyContact {  // Issanchou et al. 2016, eq 16
    long steps = 0, iterations = 0;
    bool converged = true;
    double take(const ContactSolution& s, double share) {
        ++steps;
        iterations += s.iterations;
        converged = converged && s.converged;
        return force = share * s.force;
    }
    bool solved() const { return converged; }
    double first(double eta, double s0, double theta) { return take(solve_contact(law, eta, -s0, 0.5 * theta), 0.5); }
    double next(double, double eta_old, double r0, double theta) { return take(solve_contact(law, eta_old, -r0, theta), 1); }
    std::vector<Fact> facts() const {
        auto f = TrueEnergyContact::facts();
        f.push_back({facts::contact_iterations_mean, steps > 0 ? static_cast<double>(iterations) / static_cast<double>(steps) : 0});
        return f;
    }
};

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

struct GradientPoints {  // GradientContact's, of several contacts
    ObstacleStep start, step;

    GradientPoints() = default;
    GradientPoints(std::span<const ContactLaw> laws, std::span<const double> heights, const std::optional<Thread>& thread,
                   std::span<const double> theta, double span, std::span<const double> contact_loss)
        : step(laws, heights, thread, theta, span) {
        std::vector<double> half(theta.begin(), theta.end());
        for (double& x : half) x *= 0.5;
        std::optional<Thread> taut = thread;  // at rest the outer levels are one: the newer is their mean, which takes s = k_c
        if (taut) taut->damping = 0.5 * taut->stiffness * span;
        start = ObstacleStep(laws, heights, taut, half, span);
        step.lose(contact_loss);
    }
    bool first(const double* now, const double* free, double* force) noexcept {
        const bool solved = start.solve(now, free, force);
        for (int p = 0; p < step.points(); ++p) force[p] *= 0.5;
        return solved;
    }
    bool next(const double*, const double* older, const double* free, double* force) noexcept { return step.solve(older, free, force); }
    double potential(const double* reading) const { return step.potential(reading); }
    double loss(double r_c) const { return step.loss(r_c); }
    void clear() { step.clear(); }
    std::vector<Fact> facts() const { return step.facts(); }
};

using Made = std::unique_ptr<Scheme>;

// gains(string) are those of each mode [m/N], inertia(string, gain) its W.
template <class Points, class Gains, class Inertia>
Made made_of_points(const Descriptor& descriptor, const Scene& scene, const Settings& settings, Gains gains, Inertia inertia) {
    const String s = with_profile_points(scene.strings.front(), settings);
    Scene bare = scene;
    bare.strings.front().barriers.clear();
    ModalString string = modal_string(descriptor, bare, settings);
    const Modes modes = modes_of(s, settings);
    ContactsOfString at;
    for (const Barrier& barrier : s.barriers) {
        const auto& b = std::get<LumpedBarrier>(barrier);
        at.laws.push_back({b.stiffness.k, b.exponent});
        at.heights.push_back(b.height);
        at.loss.push_back(b.contact_loss);
        const auto g = footprint_weights(modes, b.position, b.width);
        at.g.emplace_back(g.begin(), g.end());
        at.g.back().resize(string.size);
    }
    const ModalArray gain = gains(string);
    ModalArray W = inertia(string, gain);
    return std::make_unique<ModalThreePointPoints<Points>>(std::move(string), s.thread, std::move(at), gain, std::move(W),
                                                           [](const auto&... parts) { return Points(parts...); });
}

ModalArray explicit_gain(const ModalString& string) {
    return ModalArray(string.size, string.dt * string.dt / string.mass);
}

ModalArray modal_masses(const ModalString& string) {
    return ModalArray(string.count, string.mass);
}

Made made_explicit(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    if (!touches_once_without_loss(scene.strings.front())) {
        refuse_matched_points(descriptor, settings);
        return made_of_points<ExplicitPoints>(descriptor, scene, settings, explicit_gain,
                                              [](const ModalString& string, const ModalArray&) { return modal_masses(string); });
    }
    ModalString string = modal_string(descriptor, scene, settings);
    const ModalArray gain = explicit_gain(string), inertia = modal_masses(string);
    if (choice_option(settings, compliance_option) == "matched") return explicit_in_series(descriptor, scene, std::move(string), gain);
    ExplicitContact contact;
    contact.law = string.barrier;
    contact.limit = stiffness_limit(string);
    return std::make_unique<ModalThreePoint<ExplicitContact>>(std::move(string), gain, inertia, contact);
}

constexpr Option energy_option{
    "energy", "true", "what the energy columns hold: the true energy, or the one that the scheme conserves", {"true", "adapted"}};
constexpr Option explicit_options[] = {compliance_option, profile_points_option};
constexpr Option impulse_invariant_options[] = {energy_option, profile_points_option};

Made made_impulse_invariant(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    const bool true_energy = choice_option(settings, energy_option) == "true";
    const auto inertia_of = [true_energy](const ModalString& string, const ModalArray& gain) {
        ModalArray inertia = modal_masses(string);
        for (int i = 0; i < string.count && !true_energy; ++i) inertia[i] = string.dt * string.dt / gain[i];
        return inertia;
    };
    if (!touches_once_without_loss(scene.strings.front()))
        return made_of_points<GradientPoints>(descriptor, scene, settings, impulse_gain, inertia_of);
    ModalString string = modal_string(descriptor, scene, settings);
    GradientContact contact;
    contact.law = string.barrier;
    const ModalArray gain = impulse_gain(string);
    ModalArray inertia = inertia_of(string, gain);
    return std::make_unique<ModalThreePoint<GradientContact>>(std::move(string), gain, std::move(inertia), contact);
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
        return series_margin(modal_explicit_penalty, scene, settings, explicit_gain);
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
