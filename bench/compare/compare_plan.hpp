// What a comparison is going to run: which cells at which settings, which references to try in turn.
#pragma once

#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/compare/request.hpp"
#include "bench/study/cell.hpp"
#include "bench/study/reference.hpp"

namespace jvari::bench::compare {

struct Plan {
    std::vector<study::Cell> cells;
    std::vector<study::ReferenceChoice> references;
    std::vector<std::string> notes;
};

// The rows per second that cells at these rates are compared on; throws UsageError where there are none.
double tap_rate_for(const CompareRequest&, const std::vector<double>& rates);

// One plan where all rates have rows in common: 44100 a second, else as many as the lowest rate. Rates that have none, as 44100 and 48000,
// are in several plans, each with rows and references of its own. Nothing is resampled: a force is a mean over the interval between two
// rows, and its reference is the mean over the same interval. What steps in continuous time is in the first plan alone.
//
// Throws UsageError for names that do not exist and rates that --tap-rate does not divide, Refusal where no scheme represents the scene.
Plan plan_of(const CompareRequest&, const Catalogue&, const Scene&);  // of rates that have rows in common
std::vector<Plan> plans_of(const CompareRequest&, const Catalogue&, const Scene&);

// The references that such a plan has, and nothing else of it.
std::vector<study::ReferenceChoice> references_of(const CompareRequest&, const Catalogue&, const Scene&);

}  // namespace jvari::bench::compare
