// Difference between two folders of results: numbers (difference_rules.cpp) and costs
// (difference_costs.cpp).
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/study/cells.hpp"

namespace jvari::bench::suite {

// ---- Contents of a folder from compare or suite, if two such folders can be compared

struct Provenance {                           // source of the results, from manifest.json
    std::string commit, date;                 // commit: "unknown" outside git
    std::string compiler, flags, build;       // the program
    std::string cpu, cores, vectors, system;  // the machine
    std::string machine() const;              // "AMD EPYC, 2 cores, AVX3_DL, Linux 6.1"
    // ignores the system
    bool same_machine(const Provenance& o) const {
        return cpu == o.cpu && cores == o.cores && vectors == o.vectors;
    }
};

struct Results {
    std::string name;
    Provenance provenance;
    study::Cells cells;
    store::Table maps, boundaries;  // empty if absent
    store::Table shown;             // cells.csv, or the cells of results.json
};

// Throws UsageError if the folder has no manifest or neither cells nor maps, or if a file cannot be
// read.
Results read_results(const std::filesystem::path&);

// ---- The rules

enum class Turn { same, moved, better, worse };
const char* name_of(Turn);

// Change of a number for a cell in both folders; a value missing on one side is NaN there. `part`:
// part of a figure, with tap "" for the headline's.
Turn turn_of(const study::Column&, const study::TabledCell& before, const study::TabledCell& after);
Turn turn_of_fact(const std::string& name, const study::TabledCell& before,
                  const study::TabledCell& after);
Turn turn_of(double study::Figure::*part, std::size_t measure, const std::string& tap,
             const study::TabledCell& before, const study::TabledCell& after);

// ---- The changes

struct Finding {
    Turn turn;
    std::string row;     // name of the row: "tanpura_c3_release modal_two_point 44100 Hz"
    std::string column;  // "error_l2_50ms", "cost_s_per_s", "outcome"
    store::Field before, after;
    // further explanation; for a cost: the ratio and the number of cells
    std::string detail;
};

struct Only {  // names that only one folder has
    std::vector<std::string> before, after;
};

struct Difference {
    // changes in the common rows; findings for the same row stand together, headline columns first
    std::vector<Finding> findings;
    Only cells, columns, points, boundaries;
    std::vector<std::pair<const char*, const Only*>> alone() const {  // each kind with its name
        return {{"cells", &cells},
                {"columns", &columns},
                {"points", &points},
                {"boundaries", &boundaries}};
    }
    std::string references;          // changes of the references; "": none
    std::vector<std::string> notes;  // missing comparisons, with reasons
    int cells_in_both = 0;
    int to_the_last_digit = 0;  // common cells with all fields equal except costs
    int compared = 0;           // number of fields

    int count(Turn) const;
    int missing() const;  // number of cells and points that the later folder lacks
    bool worse() const { return count(Turn::worse) > 0 || missing() > 0; }
    bool nothing() const;  // true without findings and without names in only one folder
};

// Throws UsageError if no row is in both.
Difference difference(const Results& before, const Results& after);

// most_lines: for each kind
std::string text_of(const Difference&, const Results& before, const Results& after,
                    std::size_t most_lines = 20);
std::string json_of(const Difference&, const Results& before, const Results& after);

// For difference.cpp only.
struct Pair {  // row in both folders
    std::string name;
    std::size_t before, after;  // row numbers in the two tables
};
void compare_costs(const Results& before, const Results& after, const std::vector<Pair>&,
                   Difference&);

}  // namespace jvari::bench::suite
