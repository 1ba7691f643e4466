// What lies in a folder of compare or of suite: the tables of results, read for its report.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "bench/compare/record/cheapest.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::report {

struct Results {
    std::filesystem::path folder;
    std::string manifest;                      // JSON
    std::string name, source, about, command;  // command: that made the results
    compare::Controls controls = compare::Controls::stand_beside;
    store::Table cells, sounds;
    // What the page draws, cells and sounds too, by the file's name; empty where the file is
    // absent. All but those of trim, path and needs, have the columns `problem` and `series` in
    // front.
    std::map<std::string, store::Table> tables;
};

// Throws UsageError where there is no manifest.json, none of cells.csv, errors.csv,
// maps.csv and path.csv, or one of the files cannot be read.
Results read_results(const std::filesystem::path&);

// A problem is a scene at one point of what is swept; runs of different problems are not compared.
// A series is a scheme with its options, and with its modes where the table has it with several at
// one rate.

}  // namespace jvari::bench::report
