// A comparison as rows, as its manifest and as sounds.
//
// cells.csv has everything, one row per scheme x rate x modes. errors.csv has what repeats bit for
// bit on one program and cost.csv what the clock said: only those two are committed, for numbers of
// the two kinds never share a committed file.
#pragma once

#include <filesystem>

#include "bench/compare/compare.hpp"

namespace jvari::bench::compare {

store::Table cells_of(const Comparison&);
nlohmann::ordered_json manifest_of(const Comparison&, const CompareRequest&);

// sounds/ and sounds.csv: the reference, and of each scheme its lowest and its highest rate; the
// rates between while all are small.
void write_sounds(const Comparison&, const std::filesystem::path& folder);

}  // namespace jvari::bench::compare
