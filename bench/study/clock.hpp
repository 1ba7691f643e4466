// What a clock said of a job, kept apart from its numbers: those are of the program, this is of the program and of a machine. One file per
// job and kind of machine, FOLDER/<id>.<machine>.clock.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/study/job.hpp"

namespace jvari::bench::study {

struct KeptClock {
    Spread wall{};  // [s]
    Spread processor{};
    double worst_block = 0;
    store::Stamp stamp;
};

std::string clock_json(const KeptClock&, const std::string& identity);
std::optional<KeptClock> read_clock(const std::filesystem::path&, const std::string& identity);  // nothing where it is not whole
std::string clock_file(const Job&, const store::Stamp&);                                         // its name in the folder of cells

using Clocks = std::map<std::string, KeptClock>;                                                      // by the stamp's name
std::vector<Clocks> clocks_in(const std::filesystem::path& folder, const Plan&, const store::Rows&);  // of each of these cells

// The machine whose costs a set shows: one that timed all of these cells, this one before others; else the one that timed most. "" of none.
// Cells of a set are compared with each other, so none of another machine stands among them where one has them all.
struct Chosen {
    std::string machine;
    bool all = false;
};
Chosen machine_of(const std::vector<Clocks>&);

}  // namespace jvari::bench::study
