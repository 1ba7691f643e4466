// What a scheme claims as a numerical method, on scenes that are smooth enough for a few milliseconds to show it: its partials are those of
// its own relation, its error falls with the rate, and it stays sound between settings.
//
// Each bound with its reason. Partials: what the matrix pencil hears of a recursion agrees with it to 2e-8 cents (smoke suite); 1e-3 cents
// is far from that, and far below any change of an equation. Convergence: contact that begins within a step costs an order, so what is owed
// is a third of the error at 8 times the rate, and less at 8 than at 4 times. An error of 1e-6 is as good as none, and 5e-5 against the
// whole string, of which 100 modes leave out 1e-5. Leaves out scenes that need a feature which the scheme calls approximated: its limit
// there is not the scene. A map: what maps call diverged, not_converged or energy_gaining (bench/map/verdict.hpp), on the side of its
// stability limit where it is sound; adhesion is a property and no promise.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/error.hpp"
#include "bench/check/judges.hpp"
#include "bench/check/scenes.hpp"
#include "bench/map/trial.hpp"
#include "bench/suite/dispersion_facet.hpp"
#include "reference/references.hpp"

namespace jvari::bench::check {

namespace {
constexpr double cents_allowed = 1e-3, decay_allowed = 1e-3;  // [1/s]
constexpr double as_good_as_none = 1e-6, what_modes_leave_out = 5e-5, owed_fall = 1.0 / 3;
constexpr double error_of_a_reference = 1e-5;
constexpr int scenes_wanted = 3, claim_modes = 100, truth_modes = 400, points = 20;
constexpr double soft = 300;  // [N/m]: the string itself is 160 N/m under a steady force there

bool is_as_the_scene_says(const Descriptor& d, const Scene& scene) {  // nothing of it approximated
    const Features needed = needed_by(scene);
    return represents(d, scene) && needed - approximated(d) == needed;
}

// ---- Partials.

Scene ringing(bool stiff, bool damped) {
    Scene scene = string_at_rest();
    scene.duration = 0.4;
    String& s = scene.strings.front();
    s.initial = TriangleInitial{0.2, 1e-3, 0.02};
    if (!stiff) s.bending_stiffness = 0;
    if (!damped) s.damping = NoDamping{};
    return scene;
}

std::string worst_partial(const Descriptor& d, const Scene& scene, bool& any) {
    const Settings settings{contract_tap_rate, contract_tap_rate, contract_modes, {}};
    if (d.clock == Clock::continuous || !represents(d, scene) || !takes(d, scene, settings)) return "";
    const Trace trace = run(d, scene, settings).trace;
    const suite::CellSet none;
    const store::Table rows = suite::dispersion_rows({scene, d, settings, trace, nullptr, 1, none});
    for (std::size_t i = 0; i < rows.rows.size(); ++i) {
        const double cents = std::abs(rows.number(i, "own_cents") - rows.number(i, "trace_cents"));
        const double decay = std::abs(rows.number(i, "own_decay_per_s") - rows.number(i, "trace_decay_per_s"));
        if (std::isnan(cents)) continue;
        any = true;
        if (cents > cents_allowed || decay > decay_allowed)
            return fmt::format("partial {} sounds {:.3g} cents and {:.3g} per second from where its relation has it", rows.at(i, "mode"),
                               cents, decay);
    }
    return "";
}

// ---- Convergence.

Scene smooth(const char* name) {
    Scene scene = ringing(true, true);
    scene.name = name;
    scene.duration = 10e-3;
    scene.taps = {{"y", Quantity::displacement, 0, 0.3}, {"z", Quantity::displacement, 0, 0.437}};
    scene.strings.front().initial = TriangleInitial{0.3, 1e-3, 0.2};
    scene.strings.front().damping = PolynomialDamping{2, 0, 0};
    return scene;
}

// A soft obstacle that the string meets within the run; a pluck; a thread; then strings that touch nothing.
std::vector<Scene> smooth_scenes() {
    std::vector<Scene> all;
    const double node = 30 * 1.0 / (claim_modes + 1);  // of a grid with as many nodes as there are modes [m]
    all.push_back(smooth("soft_bridge"));
    all.back().strings.front().barriers = {LumpedBarrier{node, 0, -3e-4, {soft}, 1, 0}};
    all.push_back(smooth("soft_profile"));
    all.back().strings.front().barriers = {ProfileBarrier{LineCurve{-3e-3}, 0, 0.2, {1e4}, 1, 0}};
    all.push_back(smooth("plucked"));
    all.back().strings.front().initial.reset();
    all.back().strings.front().pluck = Pluck{-0.4, 6e-3, 3.0, 0.0, 0.5, 0.5};
    all.push_back(smooth("threaded"));
    all.back().strings.front().thread = Thread{node, 0, soft, 0.1, 0};
    all.push_back(smooth("free"));
    all.back().strings.front().damping = string_at_rest().strings.front().damping;
    all.push_back(smooth("free_evenly_damped"));
    all.push_back(smooth("limp"));
    all.back().strings.front().bending_stiffness = 0;
    all.push_back(smooth("limp_without_losses"));
    all.back().strings.front().bending_stiffness = 0;
    all.back().strings.front().damping = NoDamping{};
    return all;
}

double error_of(const Descriptor& d, const Scene& scene, const Settings& settings, const Trace& truth) {
    const jvari::Run r = run(d, scene, settings);
    if (r.status.outcome != Outcome::ok) return std::numeric_limits<double>::infinity();
    return relative_l2(r.trace, truth).worst;
}

// The scene's truth with these modes: of the first reference that represents it and is not the scheme itself.
std::optional<Trace> truth_of(const Descriptor& d, const Scene& scene, int modes) {
    for (const Descriptor& reference : references()) {
        const bool itself = std::string(reference.name) == d.name;
        const Settings settings{0, contract_tap_rate, modes, {}};
        if (itself || !takes(reference, scene, settings)) continue;
        jvari::Run r = run(reference, scene, settings);
        if (r.status.outcome == Outcome::ok) return std::move(r.trace);
    }
    return std::nullopt;
}

// Its limit is the string of as many modes as it has; or, where it puts back what they lack or is on a grid, the whole string.
std::string convergence_to(const Descriptor& d, const Scene& scene, const Trace& truth, double enough) {
    std::vector<double> errors;
    const bool steps = d.clock == Clock::stepped;
    for (const int times : {1, 2, 4, 8})
        if (steps || times == 1)
            errors.push_back(error_of(d, scene, {times * contract_tap_rate, contract_tap_rate, claim_modes, {}}, truth));
    const bool none = errors.back() <= (steps ? enough : error_of_a_reference);
    const bool falls = steps && errors[3] <= owed_fall * errors[0] && errors[3] < errors[2];
    if (none || falls) return "";
    std::string text = scene.name + ": errs by";
    for (const double error : errors) text += fmt::format(" {:.2g}", error);
    return text + (steps ? " at 44.1 kHz x 1, 2, 4, 8" : " from another reference");
}

std::optional<std::string> convergence_on(const Descriptor& d, const Scene& scene) {  // "": it does; nothing: not to be asked
    if (!is_as_the_scene_says(d, scene)) return std::nullopt;
    for (const int times : {1, 2, 4, 8})
        if (!takes(d, scene, {times * contract_tap_rate, contract_tap_rate, claim_modes, {}})) return std::nullopt;
    std::string found;
    for (const int modes : {claim_modes, truth_modes}) {
        const auto truth = truth_of(d, scene, modes);
        if (!truth) return std::nullopt;
        const std::string to = convergence_to(d, scene, *truth, modes == truth_modes ? what_modes_leave_out : as_good_as_none);
        if (to.empty()) return to;
        found += (found.empty() ? "" : ", and against the whole string ") + to;
    }
    return found;
}

// ---- A map: five rates x four of what makes a scheme stiff.

struct Point {
    Scene scene;
    Settings settings;
    std::string name;
};
std::vector<Point> map_of(const Descriptor& d) {
    const auto scene_at = [&d](int level) {
        Scene scene = ringing(true, true);
        scene.duration = 20e-3;
        String& s = scene.strings.front();
        s.initial = ModeInitial{1, 1.9e-3};
        if (d.represents.has(Feature::lumped_barrier)) {
            const double k[] = {1e4, 1e6, 1e8, 1e10};
            s.barriers = {LumpedBarrier{10e-3, 0, 0, {k[level]}, 1, 0}};
            return std::pair{scene, fmt::format("a bridge of {:g} N/m", k[level])};
        }
        const double stiffness[] = {0, 6.03e-5, 1e-3, 1e-2};
        s.bending_stiffness = d.represents.has(Feature::bending_stiffness) ? stiffness[level] : 0;
        if (!d.represents.has(Feature::frequency_dependent_damping)) s.damping = NoDamping{};
        return std::pair{scene, fmt::format("a bending stiffness of {:g} N m^2", s.bending_stiffness)};
    };
    std::vector<Point> all;
    for (const double rate : {22050.0, 29400.0, 44100.0, 66150.0, 96000.0})
        for (int level = 0; level < 4; ++level) {
            const auto [scene, what] = scene_at(level);
            all.push_back(
                {map::listened(scene), {rate, map::row_rate(rate), contract_modes, {}}, fmt::format("{} at {:g} Hz", what, rate)});
        }
    return all;
}
}  // namespace

Verdict partials_are_its_own_relations(const Case& c) {
    bool any = false;
    for (const bool stiff : {true, false})
        for (const bool damped : {true, false})
            if (const std::string found = worst_partial(c.scheme, ringing(stiff, damped), any); !found.empty()) return broken(found);
    return any ? kept() : not_asked("it has no relation in closed form, or no free string to hear it on");
}

Verdict converges_to_the_reference(const Case& c) {
    std::string names;
    int asked = 0;
    for (const Scene& scene : smooth_scenes()) {
        if (asked == scenes_wanted) break;
        const auto found = convergence_on(c.scheme, scene);
        if (!found) continue;
        if (!found->empty()) return broken(*found);
        names += (names.empty() ? "on " : ", ") + scene.name;
        ++asked;
    }
    return asked > 0 ? kept(names) : not_asked("it approximates or refuses every smooth scene");
}

Verdict stays_sound_over_a_map(const Case& c) {
    const Descriptor& d = c.scheme;
    if (d.balance == Balance::none) return not_asked("it promises no balance");
    int sound = 0;
    for (const Point& p : map_of(d)) {
        if (!takes(d, p.scene, p.settings)) continue;
        if (d.limit.margin && d.limit.margin(p.scene, p.settings) < 0) continue;  // on the unsound side, as it says itself
        const jvari::Run r = run(d, p.scene, p.settings, {.energy = true});
        const map::Judgement j = map::judge(map::figures_of(d, p.scene, r, nullptr));
        if (j.verdict == map::Verdict::diverged || j.verdict == map::Verdict::not_converged || j.verdict == map::Verdict::energy_gaining)
            return broken(fmt::format("{} with {}: {}", name_of(j.verdict), p.name, j.detail));
        ++sound;
    }
    return sound > 0 ? kept(fmt::format("{} of {} points", sound, points)) : not_asked("it refuses all points");
}

}  // namespace jvari::bench::check
