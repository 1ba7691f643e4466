// A comparison as rows and as its manifest.
//
// cells.csv has everything, one row per scheme x rate x modes. errors.csv has what repeats bit for bit on one program and cost.csv what
// the clock said: only those two are committed, for numbers of the two kinds never share a committed file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/compare/compare.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::compare {

store::Table cells_of(const Comparison&);
std::string manifest_of(const Comparison&, const CompareRequest&);  // JSON

// sounds/ and sounds.csv: the reference, and of each scheme its lowest and its highest rate; the rates between while all are small.
void write_sounds(const Comparison&, const std::filesystem::path& folder);

store::Table errors_only(const store::Table& cells);
store::Table cost_only(const store::Table& cells);

}  // namespace jvari::bench::compare
