// Maps from their declaration to DIR: maps.csv, boundaries.csv, and minimised reproducers in failures/. The report draws them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/map/map_file.hpp"
#include "bench/map/map_run.hpp"

namespace jvari::bench::store {
class Listener;
}

namespace jvari::bench::map {

struct RecordedMaps {
    std::vector<std::string> files;  // written
    std::string text;                // for the terminal; "" where there are no maps
};
// The folder of the request is DIR.
RecordedMaps run_and_record_maps(const std::vector<Map>&, const compare::Catalogue&, MapRequest, const store::Listener&);

}  // namespace jvari::bench::map
