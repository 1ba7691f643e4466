// The row facet `sound` of a suite: a cell's samples and its reference's lie in its record, and become sounds/*.wav and sounds.csv.
#pragma once

#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

store::Table sound_rows(const MeasuredCell&);
void write_sound_rows(const std::filesystem::path& folder, const store::Table& gathered);

}  // namespace jvari::bench::suite
