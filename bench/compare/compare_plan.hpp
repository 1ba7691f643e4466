// What a comparison is going to run: which cells at which settings, which references to try in turn.
#pragma once

#include <cmath>
#include <functional>

#include "bench/compare/compare.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::compare {

struct ReferenceChoice {
    const Descriptor* scheme;
    Settings settings;
    std::string note;                 // why this one, "" where it is the rule or was asked for
    int oversampled = 0;              // a scheme, and the multiple of the coarsest rate of three; 0: a reference
    bool kept = false;                // its run may be one of before (kept_run.hpp): the reference is of this program and not of a plugin
    std::filesystem::path kept_in{};  // a study's own folder, for all of its runs; "": kept_runs_folder(), for those worth keeping
    std::string name() const { return (oversampled ? "oversampled " : "") + std::string(scheme->name); }
};

struct Plan {
    std::vector<Cell> cells;
    std::vector<ReferenceChoice> references;
    std::vector<std::string> notes;
};

// Throws UsageError for names that do not exist and rates without a common tap rate, Refusal where no scheme represents the scene.
Plan plan_of(const CompareRequest&, const Catalogue&, const Scene&);

struct Reference {
    ReferenceChoice choice;
    Run run, moved;      // moved: started 1e-12 apart
    trust::Trust trust;  // what its certificate, or its own estimate, says of it
};
// The first of the choices that represents the scene and gets going, its two runs side by side where `jobs` are not 1; of the schemes that
// may stand in the one that estimates its own error least goes first. Throws Refusal where none does, and PastItsLimit where one of the two
// runs computes for longer than `time_limit` [s]: another in its place would make the errors a matter of the machine.
Reference run_reference(const std::vector<ReferenceChoice>&, const Scene&, int jobs, const store::Listener&, double time_limit = HUGE_VAL);

// Runs the cell and fills summary and reason. Throws Refusal. What `progress` throws ends it.
using ProgressOf = std::function<void(long done, long rows)>;
Trace run_cell(Cell&, const Scene&, const ProgressOf& progress);
// Fills its errors from what it did: from the truth, and from a reference of its own modes; nullptr: there is none.
void judge(Cell&, const Trace& done, const Trace& truth, const Trace* model);

}  // namespace jvari::bench::compare
