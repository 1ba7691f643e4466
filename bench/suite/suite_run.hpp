// Runs what of a suite is not there yet: accuracy cells side by side, then timed cells one at a time, interleaved on each scene.
//
// A cell's file appears when the cell is finished, so a suite that is stopped at any moment loses the cells under way and no other. Any
// number of processes, on any number of machines, may share a folder: each runs the next cell that nobody has, under the lock of its file.
// Each of them comes to the same records, for it waits for what the others have under way, and runs that itself where they die.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/suite/suite_record.hpp"

namespace jvari::bench::suite {

struct SuiteRun {
    std::vector<SuiteRecord> records;       // of each cell of the plan
    int ran = 0, timed = 0, read_back = 0;  // by this process; read_back: cells that others ran, or that lay there
};

// `folder`: where cells are kept, "" for nowhere. `resume`: read back what lies there. `jobs` threads (0: as many as there are cores).
SuiteRun run_suite(const SuitePlan&, const std::filesystem::path& folder, bool resume, int jobs, const store::Listener&);

// What lies in the folder of a suite that was ended: "3 of 24 cells, 5 points of maps and 2 runs of references".
std::string kept_of(const SuitePlan&, const std::filesystem::path& folder);

// All runs of references go to that folder and come from there, so that several processes make each of them once. A scheme that stands in
// as reference is not kept: who needs it makes it.
void keep_references_in(SuitePlan&, const std::filesystem::path& folder);

}  // namespace jvari::bench::suite
