// A suite spread out to its cells: each a scheme at its settings on one scene, and what addresses its result.
#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "bench/compare/compare_plan.hpp"
#include "bench/store/cell_rows.hpp"
#include "bench/suite/suite_file.hpp"

namespace jvari::bench::suite {

struct PlannedPoint {  // one scene at one point of the sweep, and who is its reference
    Scene scene;
    std::vector<std::pair<std::string, std::string>> swept;  // key, value; the last may be "element", "-thread"
    std::optional<compare::Element> element;                 // that the scene is without; an added one: that is on while it is timed
    std::vector<compare::ReferenceChoice> references;
    std::string reference_key;  // points that share it share the reference's run and its time limit
    std::string truth_key;      // likewise of the truth, whose modes are none of the cells'; "": the reference is all there is
    int truth_modes = 0;        // 0: found by doubling
    int tap = 0;                // of the spectrogram
};

struct PlannedCell {
    const CellSet* set;
    const PlannedPoint* point;
    compare::Cell cell;
    std::string identity;  // JSON: the scene's hash, the scheme, the settings, the program, what is measured
    std::string id;        // hash_of it
};

std::string what_of(const PlannedCell&);  // for people: "tanpura_c3_release: modal_two_point at 44100 Hz"

struct SuitePlan {
    std::deque<PlannedPoint> points;  // does not move what it holds
    std::vector<PlannedCell> cells;   // each identity once, in the order of the file
    std::vector<std::string> notes;   // of compare's planner, each once
};

// `plugins` are files whose contents count as part of the program. Throws UsageError, SceneFileError, BadScene, Refusal.
SuitePlan plan_of(const Suite&, const compare::Catalogue&, const std::vector<std::string>& plugins);

std::vector<store::Rows> sets_of(const SuitePlan&);  // indices of cells by the set they are of

}  // namespace jvari::bench::suite
