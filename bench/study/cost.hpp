// What a cell costs. Timed runs go one at a time, interleaved between competitors, energy probe off; the median is quoted with its
// quartiles.
#pragma once

#include <optional>
#include <vector>

#include "bench/study/cell.hpp"
#include "bench/study/elements.hpp"

namespace jvari::bench::study {

// The worst block: the longest of 64 rows over the time those rows sound, in the run where it was shortest, so that it is the scheme's
// worst and not what the machine did meanwhile. The first block of a run and failed runs do not count.
//
// Fills Cell::wall and Cell::worst_block of every cell that was run. A sample of a short run is the mean of as many runs back to back as
// last 20 ms; a cell that takes longer than 10 s for all its repeats gets fewer, two at least.
struct Contender {
    Cell* cell;
    const Scene* scene;
    std::optional<Element> added = {};  // the probe or the radiation, timed with the run
};
void time_cells(const std::vector<Contender>&, int repeats, const store::Listener&);

}  // namespace jvari::bench::study
