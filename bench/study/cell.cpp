#include "bench/study/cell.hpp"

#include <fmt/core.h>

#include "bench/store/records.hpp"
#include "bench/store/system/interruption.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::study {

namespace {
int modes_used(const Scene& scene, const Settings& settings, const std::vector<Fact>& facts) {
    if (const double n = fact_of(facts, facts::interior_nodes); n == n) return static_cast<int>(n);
    if (const double n = fact_of(facts, facts::grid_intervals); n == n)
        return static_cast<int>(n) - 1;
    return modes_for(scene, settings);
}
}  // namespace

Summary summary_of(const Descriptor& d, const Scene& scene, const Settings& settings,
                   const Run& run) {
    Summary s{};
    static_cast<Figures&>(s) = figures_of(d.balance, scene, modes_for(scene, settings), run);
    const bool continuous = d.clock == Clock::continuous;
    s.scheme = d.name;
    s.scene = scene.name;
    s.rate = continuous ? nan : settings.sample_rate;
    s.modes = modes_used(scene, settings, run.facts);
    s.dofs = run.dofs;
    s.steps = run.steps;
    s.rows = run.trace.rows;
    s.duration = run.trace.rows > 1 ? (run.trace.rows - 1) / run.trace.tap_rate : 0;
    s.wall_seconds = run.wall_seconds;
    s.ns_per_step = run.steps > 0 ? run.wall_seconds * 1e9 / run.steps : nan;
    s.times_real_time = run.wall_seconds > 0 ? s.duration / run.wall_seconds : nan;
    return s;
}

std::string Cell::status() const {
    return !ran() ? failure : !needed ? "not_needed" : name_of(summary.status.outcome);
}

Trace run_cell(Cell& cell, const Scene& scene, const ProgressOf& progress) {
    const auto scheme = make_scheme(*cell.scheme, scene, cell.settings);
    const double from = store::processor_seconds();
    Run result = run(*scheme, scene, cell.settings, {.energy = true, .progress = progress});
    const double took = store::processor_seconds() - from;
    cell.summary = summary_of(*cell.scheme, scene, cell.settings, result);
    cell.summary.processor_seconds = took;
    if (result.status.outcome != Outcome::ok)
        cell.reason = fmt::format("{} at step {}, after {:.6g} s", name_of(result.status.outcome),
                                  result.status.step, cell.summary.duration);
    return std::move(result.trace);
}

void fail(Cell& cell, const std::exception& e) {
    // the latter: not with these modes
    const bool refused = dynamic_cast<const Refusal*>(&e) || dynamic_cast<const BadScene*>(&e);
    cell.failure = refused                                        ? "refused"
                   : dynamic_cast<const store::PastItsLimit*>(&e) ? "past_time_limit"
                                                                  : "error";
    cell.reason = e.what();
}

}  // namespace jvari::bench::study
