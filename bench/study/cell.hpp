// A cell: one scheme at its settings on one scene, and what came of it. The unit of every study.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "analysis/statistics.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/sound.hpp"
#include "bench/study/errors.hpp"
#include "bench/study/summary.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::study {

struct Cell {
    const Descriptor* scheme;
    Settings settings;
    std::string failure{};  // "" where it was run; else its status: "refused", "past_time_limit", "error"
    std::string reason{};   // of a failure, or why it is not needed
    Summary summary{};      // of the accuracy run; empty where it was not run
    Errors errors{};        // from the scene's own motion (truth.hpp)
    Errors in_model{};      // from that of a string with as many modes: errors of the scheme alone; empty where none was run
    store::Sound sound{};   // of the headline's nut tap, where the run reached its end and the study wants to hear it
    Spread wall{};          // of the timed runs [s], of the whole scene or up to the failure
    Spread processor{};     // the same in processor time [s], the drift of the machine taken off (cost.cpp)
    double worst_block = std::numeric_limits<double>::quiet_NaN();  // as a fraction of its deadline, see cost.hpp
    store::Stamp stamp{};                                           // of the machine that timed it
    bool searched = false;                                          // its modes or its rate were not named
    bool added = false;                                             // more modes than it takes unasked
    bool needed = true;                                             // false: run over the headline's window alone, and not timed
    bool ran() const { return failure.empty(); }
    int modes() const { return ran() ? summary.modes : settings.modes; }
    std::string status() const;  // as tables have it: "ok", "diverged", "not_converged", "not_needed", or its failure
};

// Runs the cell with its energy probed; fills summary and reason. Throws Refusal. What `progress` throws ends it.
using ProgressOf = std::function<void(long done, long rows)>;
Trace run_cell(Cell&, const Scene& scene, const ProgressOf& progress);
void fail(Cell&, const std::exception&);  // what running it threw: its failure and the reason

}  // namespace jvari::bench::study
