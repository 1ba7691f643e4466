#include "schemes/sitar/sitar.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/barrier.hpp"
#include "scenes/start.hpp"
#include "schemes/making.hpp"

namespace jvari {

using std::numbers::pi;

SitarString sitar_string(const Descriptor& scheme, const Scene& scene, const Settings& settings,
                         const std::string& stiffness) {
    validate(scene);
    const String& string = scene.strings.front();
    if (string.tension == 0)
        throw Refusal(std::string(scheme.name) + " carries waves along a tension, and scene " +
                      scene.name + " has none");
    SitarString s;
    s.shape = string;
    s.steps_per_row = steps_per_row(settings);
    s.length = string.length;
    s.tension = string.tension;
    s.dt = 1 / settings.sample_rate;
    const Modes first = modes_of(string, 1);
    s.f0 = std::sqrt(string.tension / string.linear_density) / (2 * string.length);
    s.sigma = first.sigma.front();
    s.step_loss = std::exp(-s.sigma * s.dt);
    if (const auto* mode = string.start ? std::get_if<ModeShape>(&*string.start) : nullptr;
        mode && mode->number * s.f0 * s.dt >= 0.5)
        throw Refusal("the initial mode " + std::to_string(mode->number) +
                      " lies above half the sample rate");
    if (s.sigma > 0)
        s.facts.push_back({facts::start_phase_error, std::atan(s.sigma / first.omega0.front())});
    if (string.bending_stiffness != 0) {
        if (stiffness == "refuse")
            throw Refusal(std::string(scheme.name) + " carries one wave speed, and scene " +
                          scene.name +
                          " has bending stiffness: it runs where the option stiffness says what "
                          "becomes of it");
        if (stiffness == "ignore")
            s.facts.push_back({facts::ignored_bending_stiffness, string.bending_stiffness});
        else s.f0 = first.omega0.front() / (2 * pi);
    }
    return s;
}

void refuse_too_many_cells(double cells) {
    constexpr double most = 1 << 24;
    if (!(cells <= most))
        throw Refusal("the string is " + std::to_string(cells) +
                      " samples long from end to end; no more than " +
                      std::to_string(static_cast<long>(most)) +
                      " are carried: lower the sample rate");
}

std::vector<FreeMode> SitarString::free_modes() const {
    std::vector<FreeMode> all;
    for (int n = 1; n < cells; ++n) all.push_back({pi * n / (cells * dt), sigma});
    return all;
}

void set_integer_length(SitarString& s) {
    refuse_too_many_cells(0.5 / (s.dt * s.f0));
    s.cells = static_cast<int>(std::lround(0.5 / (s.dt * s.f0)));  // (4)
    if (s.cells < 3)
        throw Refusal("the string has fewer than 3 samples from end to end: raise the sample rate");
    s.dx = s.length / s.cells;
    s.facts.push_back({facts::period_error_cents, 1200 * std::log2(0.5 / (s.dt * s.cells) / s.f0)});
}

void lay_bridge(SitarString& s, double plucked) {
    if (s.shape.barriers.empty()) return;
    const auto& barrier = std::get<ProfileBarrier>(s.shape.barriers.front());
    if (barrier.from != 0)
        throw Refusal(
            "the bridge rule sets the wave that leaves the bridge end: the profile has to start at "
            "x = 0, not at " +
            std::to_string(barrier.from) + " m");
    const int nodes =
        std::min(static_cast<int>(std::floor(barrier.to / s.dx * (1 + 1e-12))), s.cells - 1);
    if (nodes < 1)
        throw Refusal("the bridge is shorter than one cell of " + std::to_string(s.dx) +
                      " m: raise the sample rate");
    std::vector<double> x;
    for (int m = 1; m <= nodes; ++m) x.push_back(m * s.dx);
    s.profile = heights(barrier.curve, x);  // (10), (11)
    for (int m = 0; m < nodes; ++m)
        if (plucked * initial_shape(s.shape, x[m]) < s.profile[m])
            throw Refusal("the initial shape lies below the bridge");
    // the contact law's stiffness and exponent have no effect
    s.facts.push_back({facts::rigid_barrier, 1});
    s.facts.push_back({facts::bridge_nodes, static_cast<double>(nodes)});
    s.facts.push_back({facts::bridge_length_error, nodes * s.dx - barrier.to});
}

namespace {
// Amount by which a Hann window of full width s rounds |u|/2 off, h = (1 + cos(2 pi u/s))/s: its
// second integral minus |u|/2. 0 beyond the window.
double corner(double u, double s) {
    if (std::abs(u) >= 0.5 * s) return 0;
    return u * u / (2 * s) - s / (4 * pi * pi) * std::cos(2 * pi * u / s) + s / 8 -
           s / (4 * pi * pi) - 0.5 * std::abs(u);
}

struct ShapeAt {
    double L, x;  // 0 <= x <= L
    double operator()(const ModeShape& m) const {
        return m.amplitude * std::sin(m.number * pi * x / L);
    }
    double operator()(const TableStart& t) const { return displacement_at(t, L, x); }
    double operator()(const RestStart&) const { return 0; }  // refused
    double operator()(const TriangleShape& t) const {
        const double x0 = t.position, kink = t.amplitude * L / (x0 * (L - x0));
        const double sharp = t.amplitude * (x < x0 ? x / x0 : (L - x) / (L - x0));
        // images with opposite sign beyond each end
        const double image = corner(x + x0, t.smoothing) + corner(2 * L - x - x0, t.smoothing);
        return sharp - kink * (corner(x - x0, t.smoothing) - image);
    }
};
}  // namespace

double initial_shape(const String& string, double x) {
    if (!string.start) return 0;
    const double L = string.length, z = x - 2 * L * std::floor(x / (2 * L));
    return z <= L ? std::visit(ShapeAt{L, z}, *string.start)
                  : -std::visit(ShapeAt{L, 2 * L - z}, *string.start);
}

void set_taps(SitarString& s, const Scene& scene) {
    int between = 0;
    for (const Tap& tap : scene.taps) {
        SitarTap t{tap.quantity};
        const double at = tap.position / s.dx;
        t.node = std::min(static_cast<int>(std::floor(at * (1 + 1e-12))), s.cells - 1);
        t.weight = std::max(0.0, at - t.node);
        if (t.weight < 1e-9 * s.cells) t.weight = 0;
        const bool on_string =
            tap.quantity == Quantity::displacement || tap.quantity == Quantity::velocity;
        const int last =
            tap.quantity == Quantity::velocity && s.cells * s.dx < s.length * (1 - 1e-12)
                ? s.cells - 1
                : s.cells;
        if (on_string && t.node + t.weight > last + 1e-9)
            throw Refusal("tap " + tap.name +
                          " lies in the part of the string that the filter at the peg stands for");
        if (on_string && t.weight != 0 && t.weight != 1) ++between;
        s.taps.push_back(t);
    }
    // read by linear interpolation
    if (between > 0) s.facts.push_back({facts::taps_between_nodes, static_cast<double>(between)});
}

void BridgeLedger::report(std::vector<Fact>& facts) const {
    facts.push_back({facts::bridge_energy_added, added});
    facts.push_back({facts::bridge_energy_taken, taken});
    facts.push_back({facts::smallest_contact_force, force.least});
    facts.push_back({facts::largest_contact_force, force.most});
}

}  // namespace jvari
