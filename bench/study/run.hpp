// Runs what of a plan is not there yet: accuracy runs side by side, then timed runs one at a time,
// interleaved within each set.
//
// A job's file appears when the job is finished, so a study that is stopped at any moment loses the
// jobs under way and no other. Any number of processes, on any number of machines, may share a
// folder: each runs the next job that nobody has, under the lock of its file. In the end it waits
// for those that others have under way, and runs them itself where the others die. So each comes to
// the same records.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/store/system/listener.hpp"
#include "bench/study/job.hpp"

namespace jvari::bench::study {

struct Kept {                        // where records and clocks lie
    std::filesystem::path folder{};  // "": nothing is kept
    bool resume = false;             // what lies there is read back
    // [s] of processor: of a shorter run nothing is kept, a file would take longer
    double least = 0;
    std::atomic<int> kept = 0, of = 0;  // how many records lie there, of how many
    std::atomic<int> ran = 0;           // by this process
};

// One job: read back where it lies there, else run under the lock of its file and kept. Where
// another process or thread runs it: what that comes to, or nothing unless `wait`.
std::optional<Record> record_of(const Job&, References&, Kept&, const ProgressOf&,
                                bool wait = true);

struct Study {
    std::vector<Record> records;  // of each job of the plan
    // by this process; read_back: jobs that others ran, or that lay there
    int ran = 0, timed = 0, read_back = 0;
};

// On `threads` threads (0: as many as there are cores).
Study run(const Plan&, References&, Kept&, int threads, const store::Listener&);
Study run(const Plan&, const std::filesystem::path& folder, bool resume, int threads,
          const store::Listener&);

// What lies in the folder of a study that was ended: "3 of 24 cells, 5 points of maps and 2 runs of
// references".
std::string kept_of(const Plan&, const std::filesystem::path& folder);

// All runs of references go to that folder and come from there, so that several processes make each
// of them once. A scheme that stands in as reference is not kept: who needs it makes it.
void keep_references_in(Plan&, const std::filesystem::path& folder);

}  // namespace jvari::bench::study
