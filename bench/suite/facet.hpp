// What a suite can measure of a cell. A facet beside compare's errors and cost and the spectrogram
// makes rows of the cell's accuracy run by one function, and they are gathered over all cells into
// a file of its name. A new one is a file of its own and a line of facets().
#pragma once

#include <filesystem>
#include <span>

#include "bench/store/records.hpp"
#include "bench/study/job.hpp"

namespace jvari::bench::suite {

struct Facet {
    const char* name;
    const char* meaning;
    // may come without rows; repeats bit for bit
    store::Table (*rows)(const study::Ran&) = nullptr;
};
std::span<const Facet> facets();

// ---- The row facet `sound` of a suite: a cell's samples and its reference's lie in its record,
// and become sounds/*.wav and sounds.csv.

store::Table sound_rows(const study::Ran&);
void write_sound_rows(const std::filesystem::path& folder, const store::Table& gathered);

}  // namespace jvari::bench::suite
