// Maps from their declaration to DIR: maps.csv, boundaries.csv, and minimised reproducers in failures/. The report draws them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/map/map_file.hpp"

namespace jvari {

class Console;

struct MapRequest {
    std::string title;             // of what is printed: the suite's name
    std::string program;           // program_identity
    std::filesystem::path folder;  // "": nothing is written, the text is printed all the same
    bool resume = false;
    int jobs = 0;  // 0: as many as there are cores
};

// Files written; none where there are no maps.
std::vector<std::string> run_and_record_maps(const std::vector<Map>&, const Catalogue&, const MapRequest&, const Console&);

}  // namespace jvari
