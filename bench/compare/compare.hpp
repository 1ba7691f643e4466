// A comparison: schemes x modes x rates on one scene, each against one reference on the same rows.
//
// Each cell is run once for its errors (energy probe on), then timed (study/cost.hpp). A cell that
// refuses or fails stays in the list with its reason. Of the cells that were sought and not named,
// those alone are run whole that the first 50 ms call for (needed_cells.hpp).
#pragma once

#include <limits>

#include "bench/compare/catalogue.hpp"
#include "bench/compare/request.hpp"
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
    const Scene& scene() const { return plan.points.front().scene; }
};

// Throws UsageError, BadScene, Refusal.
Comparison compare(const CompareRequest&, const Catalogue&, const store::Listener&);
Comparison compare(const CompareRequest&, const Catalogue&, const store::Listener&, study::Kept&);

}  // namespace jvari::bench::compare
