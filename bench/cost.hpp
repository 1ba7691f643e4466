// What a cell costs. Timed runs go one at a time, interleaved between competitors, energy probe off; the median is quoted with its
// quartiles.
#pragma once

#include <vector>

#include "bench/compare.hpp"

namespace jvari {

// Fills Cell::wall of every cell that was run. A sample of a short run is the mean of as many runs back to back as last 20 ms; a cell that
// takes longer than 10 s for all its repeats gets fewer, two at least.
void time_cells(std::vector<Cell>&, const Scene&, int repeats, const Console&);

}  // namespace jvari
