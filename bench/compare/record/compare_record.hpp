// A comparison as rows, as its manifest and as sounds.
//
// Numbers that repeat and measured times never share a committed file: facts.csv, errors.csv and
// cost.csv are committed (study/cells.hpp), cells.csv is to look at.
#pragma once

#include <filesystem>

#include "bench/compare/compare.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::compare {

study::Cells cells_of(const Comparison&);
nlohmann::ordered_json manifest_of(const Comparison&, const CompareRequest&);

// sounds/ and sounds.csv: the reference, and of each scheme its lowest and its highest rate; the
// rates between while all are small.
void write_sounds(const Comparison&, const std::filesystem::path& folder);

}  // namespace jvari::bench::compare
