// Runs what of a suite is not there yet: accuracy cells side by side, then timed cells one at a time, interleaved on each scene.
//
// A cell's file appears when the cell is finished, so a suite that is stopped at any moment loses the cells under way and no other. What
// processes on several machines write into one folder is one study: a cell that two of them ran is the same file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/suite/suite_record.hpp"

namespace jvari::bench::suite {

struct SuiteRun {
    std::vector<SuiteRecord> records;  // of each cell of the plan
    int ran = 0, timed = 0, read_back = 0;
    std::vector<std::string> missing;  // of what was to be gathered: cells, and clocks
};

struct SuiteWork {                    // a part of a plan, or all of it
    std::vector<std::size_t> cells;   // whose numbers are to be found
    std::vector<store::Rows> clocks;  // sets that are to be timed, each in one interleaved run
};
SuiteWork all_of(const SuitePlan&);

// `folder`: where cells are kept, "" for nowhere. `resume`: read back what lies there. `jobs` threads (0: as many as there are cores).
// Records of cells that are no part of the work are not known().
SuiteRun run_suite(const SuitePlan&, const SuiteWork&, const std::filesystem::path& folder, bool resume, int jobs, const store::Listener&);
SuiteRun run_suite(const SuitePlan&, const std::filesystem::path& folder, bool resume, int jobs, const store::Listener&);

// Runs nothing: reads what lies there, and takes the cells that are missing out of the plan.
SuiteRun gather_suite(SuitePlan&, const std::filesystem::path& folder);

// What lies in the folder of a suite that was ended: "3 of 24 cells, 5 points of maps and 2 runs of references".
std::string kept_of(const SuitePlan&, const std::filesystem::path& folder);

// All runs of references go to that folder and come from there, so that several processes make each of them once; and each is made now.
// A scheme that stands in as reference is not kept: who needs it makes it.
void keep_references_in(SuitePlan&, const std::filesystem::path& folder);
int make_references(const SuitePlan&, int jobs, const store::Listener&);  // how many

}  // namespace jvari::bench::suite
