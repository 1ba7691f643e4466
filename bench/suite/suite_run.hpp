// Runs what of a suite is not there yet: accuracy cells side by side, then timed cells one at a time, interleaved on each scene.
//
// A cell's file appears when the cell is finished, so a suite that is stopped at any moment loses the cells under way and no other. The run
// of a reference is not kept: it is made again where a cell that needs it is missing.
#pragma once

#include <filesystem>
#include <vector>

#include "bench/suite/suite_record.hpp"

namespace jvari::bench::suite {

struct SuiteRun {
    std::vector<SuiteRecord> records;  // of each cell of the plan
    int ran = 0, timed = 0, read_back = 0;
};

// `folder`: where cells are kept, "" for nowhere. `resume`: read back what lies there. `jobs` threads (0: as many as there are cores).
SuiteRun run_suite(const SuitePlan&, const std::filesystem::path& folder, bool resume, int jobs, const store::Listener&);

}  // namespace jvari::bench::suite
