// Cell: one scheme with its settings on one scene, and the results. The unit of every study.
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

// Figures of a run, beside its trace.
struct Summary : Figures {
    std::string scheme, scene;
    double rate;  // [Hz]; NaN for a continuous-time reference
    int modes;    // number in the first string; interior nodes for a scheme on a grid
    int dofs;
    long steps, rows;
    double duration;                                    // simulated [s]: up to the last valid row
    double wall_seconds, ns_per_step, times_real_time;  // NaN if the divisor is zero
    double processor_seconds = 0;                       // for an accuracy run
};

Summary summary_of(const Descriptor&, const Scene&, const Settings&, const Run&);

// Calls act(name, figure) for each number in a summary, except status and facts.
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

// measured times of a cell (cost.hpp)
struct Timing {
    // wall time for the timed runs [s], over the whole scene or up to the failure
    Spread wall{};
    // processor time for the same runs [s], corrected for the drift of the machine
    Spread processor{};
    double worst_block = std::numeric_limits<double>::quiet_NaN();  // fraction of its deadline
    store::Stamp stamp{};                                           // machine and date
};

struct Cell {
    const Descriptor* scheme;
    Settings settings;
    // "" if the cell ran; else its status: "refused", "past_time_limit", "error"
    std::string failure{};
    std::string reason{};  // reason for the failure, or for leaving the cell out
    std::string cause{};   // explanation for most of the headline error (cause.hpp); "": unknown
    Summary summary{};     // from the accuracy run; empty without a run
    Errors errors{};       // relative to the scene's own motion (truth.hpp)
    // errors relative to a string with the same number of modes, so errors due to the scheme alone;
    // empty if no such string ran
    Errors in_model{};
    // sound of the headline's nut tap, if the run reached its end and the study stores sounds
    store::Sound sound{};
    Timing clock{};
    bool searched = false;  // true: modes or rate were not named
    bool added = false;     // true: more modes than its default
    bool needed = true;     // false: run over the headline's window only, and not timed
    bool ran() const { return failure.empty(); }
    int modes() const { return ran() ? summary.modes : settings.modes; }
    // status in tables: "ok", "diverged", "not_converged", "not_needed", or the failure
    std::string status() const;
};

// Runs the cell with its energy probed; fills summary and reason. `heard`: the trace has each tap
// twice if the scheme can do so (heard_too). Throws Refusal. An exception from `progress` ends the
// run.
using ProgressOf = std::function<void(long done, long rows)>;
Trace run_cell(Cell&, const Scene& scene, bool heard, const ProgressOf& progress);
// Stores the failure and its reason from the exception that the run threw.
void fail(Cell&, const std::exception&);

}  // namespace jvari::bench::study
