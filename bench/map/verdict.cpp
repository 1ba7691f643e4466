#include "bench/map/verdict.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/energy.hpp"
#include "analysis/error.hpp"
#include "bench/store/records.hpp"
#include "bench/study/summary.hpp"

namespace jvari::bench::map {

namespace {
constexpr std::array all = {Verdict::sound,          Verdict::unjudged,      Verdict::inaccurate, Verdict::adhesive,
                            Verdict::energy_gaining, Verdict::not_converged, Verdict::diverged,   Verdict::refused};
constexpr double listening_points[] = {0.3, 0.437};  // of the length: no low mode has a node at both

double largest(std::span<const double> values) {  // infinite where a value is not finite
    double most = 0;
    for (const double x : values) most = std::max(most, std::isfinite(x) ? std::abs(x) : HUGE_VAL);
    return most;
}
}  // namespace

std::span<const Verdict> verdicts() {
    return all;
}

const char* name_of(Verdict v) {
    constexpr std::array names = {"sound", "unjudged", "inaccurate", "adhesive", "energy_gaining", "not_converged", "diverged", "refused"};
    static_assert(names.size() == all.size());
    return names[static_cast<std::size_t>(v)];
}

Verdict verdict_named(const std::string& name) {
    for (const Verdict v : all)
        if (name == name_of(v)) return v;
    throw std::runtime_error("unknown outcome " + name);
}

Judgement judge(const Figures& f) {
    const bool stopped = f.status.outcome != Outcome::ok;
    if (f.status.outcome == Outcome::diverged) return {Verdict::diverged, fmt::format("at step {}", f.status.step), f.status.step};
    if (f.displacement > std::sqrt(energy_budget))
        return {Verdict::diverged, fmt::format("displacement {:.3g} times what its energy allows", f.displacement), 0};
    if (stopped) return {Verdict::not_converged, fmt::format("at step {}", f.status.step), f.status.step};
    if (f.energy_gain > (f.balance == Balance::exact ? study::energy_allowed : gain_allowed_unpromised))
        return {Verdict::energy_gaining, fmt::format("{:.3g} of its energy gained", f.energy_gain), 0};
    if (f.pull > study::pull_allowed) return {Verdict::adhesive, fmt::format("pulls by {:.3g} of the largest contact force", f.pull), 0};
    if (f.error > error_allowed) return {Verdict::inaccurate, fmt::format("error {:.3g}", f.error), 0};
    if (std::isnan(f.displacement) && std::isnan(f.energy_gain) && std::isnan(f.pull) && std::isnan(f.error))
        return {Verdict::unjudged, "no energy, no smallest contact force and no reference to judge it by", 0};
    return {Verdict::sound, std::isnan(f.error) ? "" : fmt::format("error {:.3g}", f.error), 0};
}

Scene listened(Scene scene) {
    scene.taps.clear();
    scene = unfiltered(std::move(scene));
    for (int k = 0; k < static_cast<int>(scene.strings.size()); ++k) {
        const double L = scene.strings[k].length;
        const std::string of = k == 0 ? "" : std::to_string(k);
        scene.taps.push_back({"y" + of, Quantity::displacement, k, listening_points[0] * L});
        scene.taps.push_back({"z" + of, Quantity::displacement, k, listening_points[1] * L});
        scene.taps.push_back({"nut" + of, Quantity::nut_force, k, 0});
    }
    return scene;
}

Figures figures_of(const Descriptor& d, const Scene& scene, const Run& run, const Trace* reference) {
    Figures f;
    f.status = run.status;
    f.balance = d.balance;
    const EnergyGain energy = energy_gain(run.trace);
    f.energy_gain = energy.largest;
    f.displacement = f.error = store::nan;
    f.pull = study::pull_of(study::fact(run.facts, facts::smallest_contact_force), study::fact(run.facts, facts::largest_contact_force));
    for (int k = 0; k < run.trace.taps(); ++k) {
        const Tap& tap = scene.taps[k];
        if (tap.quantity == Quantity::displacement) {
            const String& s = scene.strings[*tap.string];
            const double most = largest(run.trace.column(k));
            const double part = std::isinf(most)    ? most
                                : energy.budget > 0 ? most / std::sqrt(energy.budget * s.length / (2 * s.tension))
                                                    : store::nan;
            f.displacement = std::fmax(f.displacement, part);
        } else if (tap.quantity == Quantity::nut_force && reference && reference->rows == run.trace.stride) {
            f.error = std::fmax(f.error, relative_l2(run.trace.column(k), reference->column(k), run.trace.tap_rate));
        }
    }
    return f;
}

}  // namespace jvari::bench::map
