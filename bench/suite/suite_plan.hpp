// A suite spread out to its jobs: each a scheme at its settings on one scene.
#pragma once

#include "bench/compare/catalogue.hpp"
#include "bench/study/job.hpp"
#include "bench/suite/suite_file.hpp"

namespace jvari::bench::suite {

// `plugins` are files whose contents count as part of the program. The suite must outlive the plan.
// Throws UsageError, SceneFileError, BadScene, Refusal.
study::Plan plan_of(const Suite&, const compare::Catalogue&,
                    const std::vector<std::string>& plugins);

}  // namespace jvari::bench::suite
