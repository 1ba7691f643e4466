// Claims of a scheme against a reference, on scenes smooth enough to show them within a few
// milliseconds. Every tap converges with the sample rate, and every tap belongs to the instant of
// its row.
//
// Forces are compared with the forces of the reference, and not with a balance of momentum. The
// force at the far end is no tap, so a balance would need the momentum of the whole string, and a
// wrong tap could hide there.
//
// Convergence: contact that begins within a step costs an order, and the quadratised forms have
// first order in the contact. A scheme therefore owes a third of each tap's error at 8 times the
// rate. The worst tap's error must be smaller at 8 times the rate than at 4 times.
//
// Negligible errors: 1e-6 against a reference with equally many modes. Against the whole string
// 5e-5 is negligible, because 100 modes leave out 1e-5. For a thread at a point 1e-3 suffices:
// there 100 modes leave out 6e-4 even with the missing compliance put back. On a profile a scheme
// keeps the error of its nodes at any rate, 4e-3 of the force with 100 nodes, so 1e-2 suffices
// there. The point thread has only displacement taps, and only schemes with modes run it: no grid
// converges to the force at a point. Scenes that need an approximated feature are left out: the
// scheme's limit there is not the scene.
//
// Instants: tested on mode 1 alone, and on the string between a soft bridge that it never leaves
// and a soft thread. A wrong frequency makes an error that grows with time, and a wrong instant
// makes an error at the start. The fit separates the two. In this tree the largest lag or lead is
// 0.06 of a step (a velocity of the sitar grids), otherwise at most 0.035.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "analysis/error.hpp"
#include "bench/check/promise.hpp"
#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::check {

bool is_as_the_scene_says(const Descriptor& d, const Scene& scene) {
    const Features needed = needed_by(scene);
    return represents(d, scene) && needed - approximated(d) == needed;
}

namespace {
constexpr double as_good_as_none = 1e-6, at_a_point = 1e-3, owed_fall = 1.0 / 3;
constexpr double error_of_a_reference = 1e-5;
constexpr int scenes_wanted = 3, claim_modes = 100, truth_modes = 400;
// [N/m]; under a steady force the string itself has 160 N/m there.
constexpr double soft = 300;
constexpr double instant_allowed = 0.1;  // [steps]
// Error of a mode whose frequency is right to the last digits.
constexpr double exact_allowed = 1e-9;

bool has(const Descriptor& d, Feature feature) {
    return (d.represents - approximated(d)).has(feature);
}

// The string of the contract, without losses, with one tap of every possible kind.
Scene string_with(const char* name, const std::optional<LumpedBarrier>& barrier,
                  const std::optional<Thread>& thread) {
    Scene scene = string_at_rest();
    scene.name = name;
    scene.taps = {{"y", Quantity::displacement, 0, 0.3},
                  {"z", Quantity::displacement, 0, 0.437},
                  {"v", Quantity::velocity, 0, 0.3},
                  {"nut", Quantity::nut_force, 0, 0}};
    String& s = scene.strings.front();
    s.damping = NoDamping{};
    if (barrier)
        s.barriers = {*barrier}, scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    if (thread) s.thread = thread, scene.taps.push_back({"thread", Quantity::thread_force, 0, 0});
    if (barrier || thread) scene.taps.push_back({"driving", Quantity::driving_force, 0, 0});
    return scene;
}

// Returns the solution by the first reference that represents the scene and is not the scheme
// itself. The solution is cached, because most schemes are compared with the same one.
const Trace* truth_of(const Descriptor& d, const Scene& scene, int modes) {
    static std::map<std::string, std::optional<Trace>> kept;
    const std::string of_scene = " " + scene_hash(scene) + " " + std::to_string(modes);
    for (const Descriptor& reference : references()) {
        if (std::string(reference.name) == d.name) continue;
        const auto [at, is_new] = kept.try_emplace(reference.name + of_scene);
        const Settings settings{0, contract_tap_rate, modes, {}};
        if (is_new && takes(reference, scene, settings)) {
            jvari::Run r = run(reference, scene, settings);
            if (r.status.outcome == Outcome::ok) at->second = std::move(r.trace);
        }
        if (at->second) return &*at->second;
    }
    return nullptr;
}

// ---- Convergence.

struct Smooth {
    Scene scene;
    // Sufficient error at 4 times 44.1 kHz if the error does not fall; else 0.
    double enough = 0;
    double whole = what_modes_leave_out;  // negligible error against the whole string
};
Smooth smooth(const char* name, const std::optional<LumpedBarrier>& barrier = {},
              const std::optional<Thread>& thread = {}) {
    Scene scene = string_with(name, barrier, thread);
    scene.duration = 10e-3;
    scene.strings.front().start = TriangleShape{0.3, 1e-3, 0.2};
    scene.strings.front().damping = PolynomialDamping{2, 0, 0};
    return {scene};
}

// Scenes in order of preference. First a wide soft obstacle met by the string within the run and a
// wide soft thread, if represented. Then a soft profile; a pluck; a thread at a point; strings
// without contact.
std::vector<Smooth> smooth_scenes(const Descriptor& d) {
    std::vector<Smooth> all;
    // Position of a node [m] on a grid with as many nodes as there are modes.
    const double node = 30 * 1.0 / (claim_modes + 1);
    std::optional<LumpedBarrier> bridge;
    std::optional<Thread> thread;
    if (has(d, Feature::lumped_barrier)) bridge = LumpedBarrier{node, 0.2, -3e-4, {soft}, 1, 0};
    if (has(d, Feature::thread)) thread = Thread{0.6, 0.2, soft, 0, 0};
    if (bridge || thread)
        all.push_back(smooth(!thread  ? "wide_bridge"
                             : bridge ? "wide_bridge_and_thread"
                                      : "wide_thread",
                             bridge, thread));
    all.push_back(smooth("soft_profile"));
    all.back().scene.strings.front().barriers = {
        ProfileBarrier{ParabolaCurve{1e-2}, 0, 0.16, {3e3}, 1, 0}};
    all.back().scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    all.back().enough = what_nodes_leave_out;
    all.push_back(smooth("plucked"));
    all.back().scene.strings.front().start.reset();
    all.back().scene.strings.front().pluck = Pluck{-0.4, 6e-3, 3.0, 0.0, 0.5, 0.5};
    // Selects modal schemes by their frequency-dependent damping: a grid approaches a point only at
    // first order.
    if (has(d, Feature::frequency_dependent_damping)) {
        all.push_back(smooth("threaded", {}, Thread{node, 0, soft, 0.1, 0}));
        all.back().scene.taps.resize(2);
        all.back().whole = at_a_point;
    }
    all.push_back(smooth("free"));
    all.back().scene.strings.front().damping = string_at_rest().strings.front().damping;
    all.push_back(smooth("free_evenly_damped"));
    all.push_back(smooth("limp"));
    all.back().scene.strings.front().bending_stiffness = 0;
    all.push_back(smooth("limp_without_losses"));
    all.back().scene.strings.front().bending_stiffness = 0;
    all.back().scene.strings.front().damping = NoDamping{};
    return all;
}

// Errors by rate and tap; empty if a run fails.
std::vector<std::vector<double>> errors_of(const Descriptor& d, const Scene& scene,
                                           std::span<const int> rates, const Trace& truth) {
    std::vector<std::vector<double>> all;
    for (const int times : rates) {
        const jvari::Run r =
            run(d, scene, {times * contract_tap_rate, contract_tap_rate, claim_modes, {}});
        if (r.status.outcome != Outcome::ok) return {};
        all.push_back(relative_l2(r.trace, truth));
    }
    return all;
}

// Returns "" if every tap converges. The limit is the string with the scheme's number of modes. For
// grids, and for schemes that put back the compliance of the missing modes, it is the whole string.
std::string convergence_to(const Descriptor& d, const Smooth& smooth, const Trace& truth,
                           double as_none) {
    static constexpr int all[] = {1, 2, 4, 8}, once[] = {1}, near[] = {4};
    const bool steps = d.clock == Clock::stepped, falling = steps && smooth.enough == 0;
    const double none = !steps ? error_of_a_reference : falling ? as_none : smooth.enough;
    const std::span<const int> rates = !steps    ? std::span<const int>(once)
                                       : falling ? all
                                                 : std::span<const int>(near);
    const auto errors = errors_of(d, smooth.scene, rates, truth);
    if (errors.empty()) return smooth.scene.name + ": its run fails";
    const auto errors_of_tap = [&](int tap) {
        std::string text = fmt::format("{}: tap {} errs by", smooth.scene.name, truth.names[tap]);
        for (const auto& at_rate : errors) text += fmt::format(" {:.2g}", at_rate[tap]);
        return text + (falling ? " at 44.1 kHz x 1, 2, 4, 8"
                       : steps ? " at 176.4 kHz"
                               : " from another reference");
    };
    for (int k = 0; k < truth.taps(); ++k)
        if (!(errors.back()[k] <= none || (falling && errors[3][k] <= owed_fall * errors[0][k])))
            return errors_of_tap(k);
    const auto worst = std::ranges::max_element(errors.back());
    const bool still_falls = falling && *worst < std::ranges::max(errors[2]);
    return *worst <= none || still_falls
               ? ""
               : errors_of_tap(static_cast<int>(worst - errors.back().begin()));
}

// "": converges; nothing: cannot be examined.
std::optional<std::string> convergence_on(const Descriptor& d, const Smooth& smooth) {
    const Scene& scene = smooth.scene;
    if (!is_as_the_scene_says(d, scene)) return std::nullopt;
    for (const int times : {1, 2, 4, 8})
        if (!takes(d, scene, {times * contract_tap_rate, contract_tap_rate, claim_modes, {}}))
            return std::nullopt;
    std::string fault;
    for (const int modes : {claim_modes, truth_modes}) {
        const Trace* truth = truth_of(d, scene, modes);
        if (!truth) return std::nullopt;
        const std::string to = convergence_to(
            d, smooth, *truth, modes == truth_modes ? smooth.whole : as_good_as_none);
        if (to.empty()) return to;
        fault += (fault.empty() ? "" : ", and against the whole string ") + to;
    }
    return fault;
}

// ---- Instants.

// Rows by which `a` lags `truth` at the start, if the lag grows linearly: a least-squares fit of
// a(n) = truth(n - late - growth n) to first order. Row 0 has no contact force, and the row beside
// it no usable slope. Returns NaN if the truth does not move.
double lateness(std::span<const double> a, std::span<const double> truth) {
    double s = 0, s_n = 0, s_nn = 0, e = 0, e_n = 0;
    for (std::size_t n = 2; n + 1 < truth.size(); ++n) {
        const double slope = 0.5 * (truth[n + 1] - truth[n - 1]), x = static_cast<double>(n),
                     error = truth[n] - a[n];
        s += slope * slope;
        s_n += slope * slope * x;
        s_nn += slope * slope * x * x;
        e += error * slope;
        e_n += error * slope * x;
    }
    return (e * s_nn - e_n * s_n) / (s * s_nn - s_n * s_n);
}

std::vector<Scene> swinging(const Descriptor& d) {  // swings in mode 1, free and held
    std::optional<LumpedBarrier> bridge;
    std::optional<Thread> thread;
    if (has(d, Feature::lumped_barrier)) bridge = LumpedBarrier{0.6, 0.4, 3e-3, {0.1 * soft}, 1, 0};
    if (has(d, Feature::thread)) thread = Thread{0.3, 0.4, 0.1 * soft, 0, 0};
    std::vector<Scene> all{string_with("free", {}, {})};
    if (bridge || thread) all.push_back(string_with("held", bridge, thread));
    for (Scene& scene : all) {
        scene.duration = 4.5e-3;  // more than half a period
        scene.strings.front().start = ModeShape{1, 1e-3};
        if (!has(d, Feature::bending_stiffness)) scene.strings.front().bending_stiffness = 0;
    }
    return all;
}

// Tests whether the scheme's own frequency for the first mode of the free string is exact to the
// last digits.
bool exact_in_time(const Descriptor& d, const Scene& scene, const Settings& settings) {
    const auto own = make_scheme(d, scene, settings)->free_modes();
    const Modes all = modes_of(scene.strings.front(), 1);
    return !own.empty() && std::abs(own[0].omega - all.omega0[0]) <= 1e-12 * all.omega0[0] &&
           own[0].sigma == 0;
}

std::string late_on(const Descriptor& d, const Scene& scene, const Settings& settings,
                    const Trace& truth) {
    const jvari::Run r = run(d, scene, settings);
    if (r.status.outcome != Outcome::ok) return scene.name + ": its run fails";
    const double steps_per_row = settings.sample_rate / settings.tap_rate;
    for (int k = 0; k < truth.taps(); ++k) {
        const double late = steps_per_row * lateness(r.trace.column(k), truth.column(k));
        if (!(std::abs(late) <= instant_allowed))
            return fmt::format("{}: tap {} is {:.2g} of a step {} at {:g} kHz", scene.name,
                               truth.names[k], std::abs(late), late > 0 ? "late" : "early",
                               settings.sample_rate / 1000);
    }
    const double error = relative_l2(r.trace.column(0), truth.column(0), truth.tap_rate);
    if (scene.name == "free" && exact_in_time(d, scene, settings) && !(error <= exact_allowed))
        return fmt::format(
            "{}: its mode 1 has the scene's frequency, and tap {} errs by {:.2g} at {:g} kHz",
            scene.name, truth.names[0], error, settings.sample_rate / 1000);
    return "";
}
}  // namespace

Verdict converges_to_the_reference(const Case& c) {
    std::string names;
    int examined = 0;
    for (const Smooth& smooth : smooth_scenes(c.scheme)) {
        if (examined == scenes_wanted) break;
        const auto fault = convergence_on(c.scheme, smooth);
        if (!fault) continue;
        if (!fault->empty()) return broken(*fault);
        names += (names.empty() ? "on " : ", ") + smooth.scene.name;
        ++examined;
    }
    return examined > 0 ? kept(names) : not_asked("it approximates or refuses every smooth scene");
}

Verdict writes_rows_at_their_instants(const Case& c) {
    const Descriptor& d = c.scheme;
    if (d.clock == Clock::continuous) return not_asked("it has no step");
    std::string names;
    for (const Scene& scene : swinging(d)) {
        const Trace* truth =
            is_as_the_scene_says(d, scene) ? truth_of(d, scene, contract_modes) : nullptr;
        if (!truth) continue;
        for (const int times : {1, 4}) {
            const Settings settings{
                times * contract_tap_rate, contract_tap_rate, contract_modes, {}};
            if (!takes(d, scene, settings)) continue;
            if (const std::string fault = late_on(d, scene, settings, *truth); !fault.empty())
                return broken(fault);
            if (times == 1) names += (names.empty() ? "on " : ", ") + scene.name;
        }
    }
    return names.empty() ? not_asked("it approximates or refuses a string that swings in one mode")
                         : kept(names);
}

}  // namespace jvari::bench::check
