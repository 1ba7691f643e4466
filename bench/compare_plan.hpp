// What a comparison is going to run: which cells at which settings, which references to try in turn.
#pragma once

#include "bench/compare.hpp"

namespace jvari {

struct ReferenceChoice {
    const Descriptor* scheme;
    Settings settings;
    std::string note;  // why this one, "" where it is the rule or was asked for
};

struct Plan {
    std::vector<Cell> cells;
    std::vector<ReferenceChoice> references;
    std::vector<std::string> notes;
};

// Throws UsageError for names that do not exist and rates without a common tap rate, Refusal where no scheme represents the scene.
Plan plan_of(const CompareRequest&, const Catalogue&, const Scene&);

}  // namespace jvari
