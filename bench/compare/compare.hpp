// A comparison: schemes x modes x rates on one scene, each against one reference on the same rows.
//
// Each cell is run once for its errors (energy probe on), then timed (study/cost.hpp). A cell that
// refuses or fails stays in the list with its reason. Of the cells that were sought and not named,
// those alone are run whole that the first 50 ms call for (mark_needed).
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "bench/compare/advice.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/records.hpp"
#include "bench/study/run.hpp"

namespace jvari::bench::compare {

struct Comparison {
    study::Plan plan;      // of one point, or of one for each kind of rows
    study::Study outcome;  // of each job of the plan
    study::Headline headline;
    study::ReferenceChoice reference;
    study::Summary reference_summary;
    // what the reference of the first point is known to
    study::Against against;
    // of the reference against itself with half its modes [s]
    double horizon = std::numeric_limits<double>::quiet_NaN();
    store::Sound reference_sound;
    // where settings were sought: what two runs advise for 1 % over the headline's window
    std::optional<Advice> advice;
    const Scene& scene() const { return plan.points.front().scene; }
};

// Throws UsageError, BadScene, Refusal.
Comparison compare(const CompareRequest&, const Catalogue&, const store::Listener&);
// `measure`: what else is measured of each cell (study::Job).
Comparison compare(const CompareRequest&, const Catalogue&, const store::Listener&, study::Kept&,
                   const std::function<void(const study::Ran&, study::Record&)>& measure = {});

// What two runs advise for 1 % over the headline's window, else for 3 dB: of the scheme that is
// advised unasked, or of the first of those asked for whose error two runs tell; nothing where
// there is none.
std::optional<Advice> advice_on(const Scene&, const CompareRequest&, const Catalogue&,
                                const store::Listener&);

// ---- Which of the cells that were sought are worth a whole run and a clock.
//
// All run over the headline's window first. A cell is left out where another that surely costs less
// does as well there: its error is larger by a tenth at most, and it keeps every accuracy of the
// table of the cheapest that the cell keeps. It is left out as well where such another keeps all of
// them, or where it failed or has flags and its modes were not named. So no cell that is left out
// could be the cheapest for a waveform.
//
// Surely less: a thirty-second of the steps times the state; of more modes than a form of a scheme
// takes unasked, fewer or as many modes at a rate that is no higher. No clock is asked, so that the
// same cells are run on every machine.

// Cells that were run over the window, their headline errors and what the reference is uncertain by
// there (NaN: unknown, counts as 0). Those that are not needed get needed = false and a reason.
void mark_needed(std::vector<study::Cell>&, const std::vector<double>& errors, double certificate);

}  // namespace jvari::bench::compare
