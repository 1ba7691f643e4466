// What a comparison is going to run: which cells at which settings, which references to try in
// turn.
#pragma once

#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/study/job.hpp"

namespace jvari::bench::compare {

// The rows per second that cells at these rates are compared on; throws UsageError where there are
// none.
double tap_rate_for(const CompareRequest&, const std::vector<double>& rates);

// BadScene where the scene has no row at that tap rate, UsageError where its rows do not fit in
// memory.
void require_rows(const Scene&, const Settings&);

// Adds the cells of a comparison as jobs like `like`, and what they are compared on:
// points like `common`, with references and reference modes as asked.
//
// One point where all rates have rows in common: 44100 a second, else as many as the lowest rate.
// Rates that have none, as 44100 and 48000, are on several points, each with rows and references of
// its own. Nothing is resampled: a force is a mean over the interval between two rows, and its
// reference is the mean over the same interval. What steps in continuous time is on the first point
// alone.
//
// Throws UsageError for names that do not exist and rates that --tap-rate does not divide, Refusal
// where no scheme represents the scene.
void add_jobs(study::Plan& into, const CompareRequest&, const Catalogue&,
              const study::Point& common, const study::Job& like);

// The references of the first of these points, and nothing else of it.
std::vector<study::ReferenceChoice> references_of(const CompareRequest&, const Catalogue&,
                                                  const Scene&);

}  // namespace jvari::bench::compare
