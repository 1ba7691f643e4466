// A cell: one scheme at its settings on one scene, and what came of it. The unit of every study.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "analysis/judgement.hpp"
#include "analysis/statistics.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/study/errors.hpp"

namespace jvari::bench::study {

// What a run has to say of itself beside its trace.
struct Summary : Figures {
    std::string scheme, scene;
    double rate;  // [Hz]; NaN for a continuous-time reference
    int modes;    // of the first string; interior nodes for a scheme on a grid
    int dofs;
    long steps, rows;
    double duration;                                    // simulated [s]: up to the last valid row
    double wall_seconds, ns_per_step, times_real_time;  // NaN where there is nothing to divide
    double processor_seconds = 0;                       // of an accuracy run
};

Summary summary_of(const Descriptor&, const Scene&, const Settings&, const Run&);

// Calls act(name, figure) for each number of a summary but those of its status and its facts.
template <class Summary_, class Act>
void each_figure(Summary_& s, Act act) {
    act("rate", s.rate);
    act("modes", s.modes);
    act("dofs", s.dofs);
    act("steps", s.steps);
    act("rows", s.rows);
    act("duration", s.duration);
    act("wall_seconds", s.wall_seconds);
    act("ns_per_step", s.ns_per_step);
    act("times_real_time", s.times_real_time);
    act("processor_seconds", s.processor_seconds);
    act("energy_residual_per_step", s.energy_residual_per_step);
    act("energy_residual_accumulated", s.energy_residual_accumulated);
    act("smallest_contact_force", s.smallest_contact_force);
    act("largest_contact_force", s.largest_contact_force);
    act("deepest_penetration", s.deepest_penetration);
    act("energy_gain", s.energy_gain);
    act("largest_over_bound", s.largest_over_bound);
}

// what a clock said of a cell (cost.hpp)
struct Timing {
    // of the timed runs [s], of the whole scene or up to the failure
    Spread wall{};
    // the same in processor time [s], the drift of the machine taken off
    Spread processor{};
    double worst_block = std::numeric_limits<double>::quiet_NaN();  // as a fraction of its deadline
    store::Stamp stamp{};                                           // of the machine
};

struct Cell {
    const Descriptor* scheme;
    Settings settings;
    // "" where it was run; else its status: "refused", "past_time_limit", "error"
    std::string failure{};
    std::string reason{};  // of a failure, or why it is not needed
    std::string cause{};   // of most of its headline error (cause.hpp); "": none is known
    Summary summary{};     // of the accuracy run; empty where it was not run
    Errors errors{};       // from the scene's own motion (truth.hpp)
    // from that of a string with as many modes: errors of the scheme alone; empty where none was
    // run
    Errors in_model{};
    // of the headline's nut tap, where the run reached its end and the study wants to hear it
    store::Sound sound{};
    Timing clock{};
    bool searched = false;  // its modes or its rate were not named
    bool added = false;     // more modes than it takes unasked
    bool needed = true;     // false: run over the headline's window alone, and not timed
    bool ran() const { return failure.empty(); }
    int modes() const { return ran() ? summary.modes : settings.modes; }
    // as tables have it: "ok", "diverged", "not_converged", "not_needed", or its failure
    std::string status() const;
};

// Runs the cell with its energy probed; fills summary and reason. Throws Refusal. What `progress`
// throws ends it.
using ProgressOf = std::function<void(long done, long rows)>;
Trace run_cell(Cell&, const Scene& scene, const ProgressOf& progress);
void fail(Cell&, const std::exception&);  // what running it threw: its failure and the reason

}  // namespace jvari::bench::study
