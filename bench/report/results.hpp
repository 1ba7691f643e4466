// What lies in a folder of compare or of suite: the tables of results, read for its report.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/compare/record/cheapest.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::report {

struct Results {
    std::filesystem::path folder;
    std::string manifest;                      // JSON
    std::string name, source, about, command;  // command: that made the results
    std::string suite;                         // "": a comparison, a trim
    compare::Controls controls = compare::Controls::stand_beside;
    std::vector<std::string> taps;                       // of compare's scene
    std::vector<std::pair<std::string, double>> floors;  // noise floor of an error column, where the manifest holds them
    // Empty where the file is absent. Each row has the columns `problem` and `series` in front (below).
    store::Table cells, dispersion, convergence, scaling, maps, boundaries, sounds;
    store::Table path, needs;  // of trim, as they are
};

// Throws UsageError where there is no manifest.json, none of cells.csv, errors.csv, maps.csv and path.csv, or one of the files cannot be
// read.
Results read_results(const std::filesystem::path&);
// A table of the folder as it is: "trace" of trace.csv. "cells" of a record is errors.csv with cost.csv. Empty where the file is absent.
store::Table table_of(const std::filesystem::path& folder, const std::string& name);

// A problem is a scene at one point of what is swept; runs of different problems are not compared. A series is a scheme with its options,
// and with its modes where the table has it with several at one rate.
std::vector<std::string> distinct(const store::Table&, const std::string& column);  // its texts, in the order in which they first come up
// `text` fit to stand in a file's name, which is that of no other of `all`.
std::string file_part(const std::string& text, const std::vector<std::string>& all);

}  // namespace jvari::bench::report
