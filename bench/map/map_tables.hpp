// Maps as rows (maps.csv, boundaries.csv), as text, and as files of a suite. The report draws them.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/map/map_run.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::map {

store::Table maps_table(const MapRun&);

// Files of minimised reproducers by scheme and outcome. A boundary names that of the side that
// fails, of the upper one where both do.
using Reproducers = std::map<std::pair<std::string, study::Verdict>, std::string>;
store::Table boundaries_table(const MapRun&, const Reproducers&);

// for the terminal: outcomes of each map and scheme, boundaries that have a theory
std::string maps_text(const MapRun&);

struct RecordedMaps {
    std::vector<std::string> files;  // written
    std::string text;                // for the terminal; "" where there are no maps
};
// Runs them, and writes maps.csv, boundaries.csv and minimised reproducers in failures/ where there
// is a folder.
RecordedMaps run_and_record_maps(const std::vector<Map>&, const compare::Catalogue&,
                                 const MapRequest&, const store::Listener&);

}  // namespace jvari::bench::map
