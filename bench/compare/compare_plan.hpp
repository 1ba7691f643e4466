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

// Throws UsageError for names that do not exist and rates without a common tap rate, Refusal where no scheme represents the scene.
Plan plan_of(const CompareRequest&, const Catalogue&, const Scene&);

}  // namespace jvari::bench::compare
