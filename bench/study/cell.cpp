#include "bench/study/cell.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "analysis/energy.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/time_limit.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::study {

namespace {

int modes_used(const Scene& scene, const Settings& settings, const std::vector<Fact>& facts) {
    if (const double n = fact(facts, facts::interior_nodes); n == n) return static_cast<int>(n);
    if (const double n = fact(facts, facts::grid_intervals); n == n) return static_cast<int>(n) - 1;
    return modes_for(scene, settings);
}

double largest(std::span<const double> values) {  // infinite where a value is not finite
    double most = 0;
    for (const double x : values) most = std::max(most, std::isfinite(x) ? std::abs(x) : HUGE_VAL);
    return most;
}

// Of all displacement taps, over what `energy` could make of a string under its tension: |y| <= sqrt(E L/(2 T)).
double displacement_of(const Scene& scene, const Trace& trace, double energy) {
    double displacement = store::nan;
    for (int k = 0; k < trace.taps(); ++k) {
        const Tap& tap = scene.taps[k];
        if (tap.quantity != Quantity::displacement) continue;
        const String& s = scene.strings[*tap.string];
        const double most = largest(trace.column(k));
        displacement = std::fmax(displacement, std::isinf(most) ? most
                                               : energy > 0     ? most / std::sqrt(energy * s.length / (2 * s.tension))
                                                                : store::nan);
    }
    return displacement;
}
}  // namespace

double fact(const std::vector<Fact>& facts, const std::string& name) {
    double worst = store::nan;
    for (const Fact& f : facts) {
        if (f.name == name) return f.value;
        if (!f.name.starts_with("string.") || !f.name.ends_with("." + name)) continue;
        worst = name == facts::smallest_contact_force.name ? std::fmin(worst, f.value) : std::fmax(worst, f.value);
    }
    return worst;
}

Summary summary_of(const Descriptor& d, const Scene& scene, const Settings& settings, const Run& run) {
    Summary s;
    const bool continuous = d.clock == Clock::continuous;
    s.scheme = d.name;
    s.scene = scene.name;
    s.rate = continuous ? store::nan : settings.sample_rate;
    s.modes = modes_used(scene, settings, run.facts);
    s.dofs = run.dofs;
    s.steps = run.steps;
    s.rows = run.trace.rows;
    s.duration = run.trace.rows > 1 ? (run.trace.rows - 1) / run.trace.tap_rate : 0;
    s.wall_seconds = run.wall_seconds;
    s.ns_per_step = run.steps > 0 ? run.wall_seconds * 1e9 / run.steps : store::nan;
    s.times_real_time = run.wall_seconds > 0 ? s.duration / run.wall_seconds : store::nan;
    s.status = run.status;
    const EnergyBalance balance = energy_balance(run.trace);
    // A scheme that promises no balance may leave its columns empty: zeros that "close" say nothing.
    const bool silent = d.balance == Balance::none && !(balance.largest_stored > 0);
    s.energy_residual_per_step = silent ? store::nan : balance.step;
    s.energy_residual_accumulated = silent ? store::nan : balance.accumulated;
    s.smallest_contact_force = fact(run.facts, facts::smallest_contact_force);
    s.largest_contact_force = fact(run.facts, facts::largest_contact_force);
    s.deepest_penetration = fact(run.facts, facts::deepest_penetration);
    const EnergyGain gain = energy_gain(run.trace);
    s.energy_gain = gain.largest;
    s.largest_displacement = displacement_of(scene, run.trace, gain.budget);
    const auto told_above = [](const Fact& f) {
        return f.name == facts::smallest_contact_force.name || f.name == facts::largest_contact_force.name ||
               f.name == facts::deepest_penetration.name;
    };
    for (const Fact& f : run.facts)
        if (!told_above(f)) s.facts.push_back(f);
    return s;
}

std::string Cell::status() const {
    return !ran() ? failure : !needed ? "not_needed" : name_of(summary.status.outcome);
}

Trace run_cell(Cell& cell, const Scene& scene, const ProgressOf& progress) {
    RunOptions options;
    options.energy = true;
    options.progress = progress;
    const auto scheme = make_scheme(*cell.scheme, scene, cell.settings);
    const double from = store::processor_seconds();
    Run result = run(*scheme, scene, cell.settings, options);
    const double took = store::processor_seconds() - from;
    cell.summary = summary_of(*cell.scheme, scene, cell.settings, result);
    cell.summary.processor_seconds = took;
    if (result.status.outcome != Outcome::ok)
        cell.reason =
            fmt::format("{} at step {}, after {:.6g} s", name_of(result.status.outcome), result.status.step, cell.summary.duration);
    return std::move(result.trace);
}

void fail(Cell& cell, const std::exception& e) {
    const bool refused = dynamic_cast<const Refusal*>(&e) || dynamic_cast<const BadScene*>(&e);  // the latter: not with these modes
    cell.failure = refused ? "refused" : dynamic_cast<const store::PastItsLimit*>(&e) ? "past_time_limit" : "error";
    cell.reason = e.what();
}

}  // namespace jvari::bench::study
