// Maps as rows (maps.csv, boundaries.csv) and as text.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "bench/map/map_run.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::map {

store::Table maps_table(const MapRun&);

// Files of minimised reproducers by scheme and outcome. A boundary names that of the side that fails, of the upper one where both do.
using Reproducers = std::map<std::pair<std::string, Verdict>, std::string>;
store::Table boundaries_table(const MapRun&, const Reproducers&);

std::string maps_text(const MapRun&);  // for the terminal: outcomes of each map and scheme, boundaries that have a theory

}  // namespace jvari::bench::map
