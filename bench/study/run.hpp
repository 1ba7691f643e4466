// Runs the missing jobs of a plan: first the accuracy runs side by side, then the timed runs,
// interleaved within each set, one at a time.
//
// A job's file appears when the job is finished, so a study stopped at any moment loses only the
// jobs under way. Any number of processes, on any number of machines, may share a folder. Each
// process takes the next free job, under the lock of the job's file. At the end a process waits for
// the others' jobs, and runs them itself if the others die. So every process gets the same records.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/store/system/listener.hpp"
#include "bench/study/job.hpp"

namespace jvari::bench::study {

struct Kept {                        // folder with records and clocks
    std::filesystem::path folder{};  // "": nothing is kept
    bool resume = false;             // true: reads back the files in the folder
    // Runs below this limit [s of processor time] are not kept, because a file would take longer.
    double least = 0;
    std::atomic<int> kept = 0, of = 0;  // number of records in the folder, and of all jobs
    std::atomic<int> ran = 0;           // by this process
};

// Record for one job. Reads the file if there is one; else runs the job under the lock of the file
// and keeps the record. If another process or thread is running the job, waits for the result, or
// returns nothing if not `wait`.
std::optional<Record> record_of(const Job&, References&, Kept&, const ProgressOf&,
                                bool wait = true);

struct Study {
    std::vector<Record> records;  // a record for each job in the plan
    // jobs by this process; read_back: jobs from the folder or from other processes
    int ran = 0, timed = 0, read_back = 0;
};

// Runs the plan on `threads` threads (0: the number of cores).
Study run(const Plan&, References&, Kept&, int threads, const store::Listener&);
Study run(const Plan&, const std::filesystem::path& folder, bool resume, int threads,
          const store::Listener&);

// Text about the folder of a stopped study: "3 of 24 cells, 5 of 9 points of maps and 2 runs of
// references". One plan may be empty.
std::string kept_of(const Plan& cells, const Plan& points, const std::filesystem::path& folder);

// Keeps all reference runs in that folder and reads them there, so that several processes make each
// run once. Schemes that stand in are not kept: each process runs its own.
void keep_references_in(Plan&, const std::filesystem::path& folder);

}  // namespace jvari::bench::study
