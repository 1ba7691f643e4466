// Cost of a cell. Timed runs go one at a time, interleaved between competitors, with the energy
// probe off. The median is quoted with its quartiles.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/study/cell.hpp"
#include "bench/study/job.hpp"

namespace jvari::bench::study {

// Sample of a clock: the mean over consecutive runs that together last `shortest` [s], at most a
// thousand runs. `worst_block` is a fraction of the deadline, NaN if no block was timed.
struct Sample {
    double wall, processor;  // [s] of one run
    double worst_block;
};
Sample sample_of(const Descriptor&, const Scene&, const Settings&, double shortest);

// Times the cells and fills in Cell::clock for every cell that ran. A sample lasts at least 20 ms.
// A cell that needs more than 10 s for all repeats gets fewer, at least two.
//
// The worst block is the longest time for 64 rows, divided by the time that those rows sound. The
// smallest value over the runs is taken, so that disturbances by the machine are not blamed on the
// scheme. The first block in a run and failed runs do not count.
struct Contender {
    Cell* cell;
    const Scene* scene;
};
void time_cells(const std::vector<Contender>&, int repeats, const store::Listener&);

// ---- Clock files. Measured times are stored apart from a job's numbers: the numbers depend on the
// program, the times also on the machine. A folder has one machine's costs, in FOLDER/<id>.clock.

std::string clock_json(const Timing&, const std::string& identity);
// nothing if the file is incomplete
std::optional<Timing> read_clock(const std::filesystem::path&, const std::string& identity);
// file name in the folder of cells
std::string clock_file(const Job&);

}  // namespace jvari::bench::study
