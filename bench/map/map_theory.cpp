#include "bench/map/map_theory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bench/map/verdict.hpp"
#include "scenes/modes.hpp"
#include "schemes/grid/finite_difference.hpp"

namespace jvari {

namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double grid_margin(const Descriptor& d, const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    const double dt = 1 / settings.sample_rate, intervals = number_option(settings, "grid", 0);
    const bool theta = std::string(d.name) == "finite_difference_theta";
    if (!(intervals > 0) || !(theta || std::string(d.name) == "finite_difference_explicit")) return nan;
    const double asked = theta ? number_option(settings, "theta", 0) : 0;
    const double limit = !theta       ? explicit_spacing_limit(s, fit_losses(s), dt)
                         : asked != 0 ? theta_spacing_limit(s, dt, asked)
                                      : theta_spacing_limit(s, dt);
    return s.length / intervals / limit - 1;
}

// det of the string's recursion with the springs k g g' at z = -1, by the compliances there: den = 1 + C + C~ of each mode, with
// C = 2 R cos(omega dt), C~ = R^2. The thread is its spring alone: its damper acts on y^{n+1} - y^{n-1} = 0.
double penalty_margin(const Descriptor& d, const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    if (std::string(d.name) != "modal_explicit_penalty" || s.barriers.empty()) return nan;
    const auto* barrier = std::get_if<LumpedBarrier>(&s.barriers.front());
    if (!barrier || barrier->exponent != 1) return nan;
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

double nyquist_margin(const Descriptor&, const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    const Modes modes = modes_of(s, modes_for(s, settings));
    const double w = std::sqrt(std::max(0.0, omega_squared_damped(modes.omega0.back(), modes.sigma.back())));
    return 0.5 * settings.sample_rate * 2 * std::numbers::pi / w - 1;
}

// With a_i = omega dt/sin(omega dt) the scheme conserves sum a_i E_i, E_i true. All of E in mode j and a_i E_i then the same on average for
// all i is E (a_j mean(1/a_i) - 1) more than there was. No mode near its limit is left out: modes above half the rate are refused.
double shares_margin(const Descriptor& d, const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    const auto* start = s.initial ? std::get_if<ModeInitial>(&*s.initial) : nullptr;
    if (std::string(d.name) != "modal_impulse_invariant" || !start || !std::holds_alternative<NoDamping>(s.damping)) return nan;
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

struct Theory {
    const char* name;
    double (*margin)(const Descriptor&, const Scene&, const Settings&);
};
constexpr Theory known[] = {
    {"grid_limit", grid_margin}, {"penalty_limit", penalty_margin}, {"nyquist", nyquist_margin}, {"equal_shares", shares_margin}};
}  // namespace

std::vector<std::string> theories() {
    std::vector<std::string> names;
    for (const Theory& t : known) names.emplace_back(t.name);
    return names;
}

bool is_theory(const std::string& name) {
    return std::any_of(std::begin(known), std::end(known), [&name](const Theory& t) { return name == t.name; });
}

double theory_margin(const std::string& name, const Descriptor& d, const Scene& scene, const Settings& settings) {
    for (const Theory& t : known)
        if (name == t.name) return t.margin(d, scene, settings);
    return nan;
}

}  // namespace jvari
