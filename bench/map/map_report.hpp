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

struct MapRequest {
    std::string program;           // program_identity
    std::filesystem::path folder;  // "": nothing is written
    Points points = Points::run_again;
    int jobs = 0;  // 0: as many as there are cores
};

struct RecordedMaps {
    std::vector<std::string> files;    // written
    std::string text;                  // for the terminal; "" where there are no maps
    std::vector<std::string> missing;  // points that were to be read: "stiffness_rate: modal_two_point at rate = 88200"
};
RecordedMaps run_and_record_maps(const std::vector<Map>&, const compare::Catalogue&, const MapRequest&, const store::Listener&);

}  // namespace jvari::bench::map
