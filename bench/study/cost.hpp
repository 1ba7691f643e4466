// What a cell costs. Timed runs go one at a time, interleaved between competitors, energy probe
// off; the median is quoted with its quartiles.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/study/cell.hpp"
#include "bench/study/job.hpp"

namespace jvari::bench::study {

// One sample of a clock: the mean of as many runs back to back as last `shortest` [s], a thousand
// at most. `worst_block` as a fraction of its deadline, NaN where none was timed.
struct Sample {
    double wall, processor;  // [s] of one run
    double worst_block;
};
Sample sample_of(const Descriptor&, const Scene&, const Settings&, double shortest);

// The worst block: the longest of 64 rows over the time those rows sound, in the run where it was
// shortest, so that it is the scheme's worst and not what the machine did meanwhile. The first
// block of a run and failed runs do not count.
//
// Fills Cell::clock of every cell that was run. A sample lasts 20 ms at least; a cell that takes
// longer than 10 s for all its repeats gets fewer, two at least.
struct Contender {
    Cell* cell;
    const Scene* scene;
};
void time_cells(const std::vector<Contender>&, int repeats, const store::Listener&);

// ---- What a clock said of a job, kept apart from its numbers: those are of the program, this is
// of the program and of a machine. A folder has the costs of one machine, FOLDER/<id>.clock.

std::string clock_json(const Timing&, const std::string& identity);
// nothing where it is not whole
std::optional<Timing> read_clock(const std::filesystem::path&, const std::string& identity);
// its name in the folder of cells
std::string clock_file(const Job&);

}  // namespace jvari::bench::study
