// Comparison: schemes x modes x rates on one scene, each against one reference on the same rows.
//
// Each cell runs once for its errors (energy probe on), then is timed (study/cost.hpp). A cell that
// refuses or fails stays in the list with its reason. A cell that the search added runs whole only
// if its first 50 ms justify the run (mark_needed).
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
    study::Plan plan;      // single point, or a point for each kind of rows
    study::Study outcome;  // results for each job of the plan
    study::Headline headline;
    study::ReferenceChoice reference;
    study::Summary reference_summary;
    // uncertainty of the first point's reference
    study::Against against;
    // horizon from the reference against itself with half its modes [s]
    double horizon = std::numeric_limits<double>::quiet_NaN();
    store::Sound reference_sound;
    // advice from two runs for 1 % over the headline's window, if settings were searched
    std::optional<Advice> advice;
    const Scene& scene() const { return plan.points.front().scene; }
};

// Throws UsageError, BadScene, Refusal.
Comparison compare(const CompareRequest&, const Catalogue&, const store::Listener&);
// `measure`: further measurements on each cell (study::Job).
Comparison compare(const CompareRequest&, const Catalogue&, const store::Listener&, study::Kept&,
                   const std::function<void(const study::Ran&, study::Record&)>& measure = {});

// Advice from two runs for 1 % over the headline's window, else for 3 dB. Takes the default scheme
// for advice, or the first requested scheme with a reliable estimate; nothing if there is none.
std::optional<Advice> advice_on(const Scene&, const CompareRequest&, const Catalogue&,
                                const store::Listener&);

// ---- Selection of the searched cells that deserve a whole run and a timing.
//
// All cells first run over the headline's window. A searched cell is left out if another cell
// surely costs less and does as well there. "As well" means either of two conditions. The other's
// error is at most a ninth larger, and the other keeps every accuracy in the table of the cheapest
// that the cell keeps. Or the other keeps all these accuracies. A cell with added modes is also
// left out if the run failed or has flags. So no cell left out could be the cheapest for a
// waveform.
//
// "Surely less" means at most a thirty-second of the work (steps times state). For a cell with
// added modes, compared with the same scheme and options, "surely less" means less work with no
// more modes at no higher rate. The selection uses no measured time, so that every machine runs the
// same cells.

// Marks cells that ran over the window, from their headline errors and the reference's uncertainty
// there (NaN: unknown, counts as 0). Cells left out get needed = false and a reason.
void mark_needed(std::vector<study::Cell>&, const std::vector<double>& errors, double certificate);

}  // namespace jvari::bench::compare
