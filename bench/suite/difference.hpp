// Two folders of results: what changed from one to the other, number by number
// (difference_rules.cpp) and by the clock (difference_costs.cpp).
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/study/cells.hpp"

namespace jvari::bench::suite {

// ---- What lies in a folder of compare or suite, as far as two such folders can be compared

struct Provenance {                           // by what, as manifest.json has it
    std::string commit, date;                 // commit: "unknown" outside git
    std::string compiler, flags, build;       // the program
    std::string cpu, cores, vectors, system;  // the machine
    std::string machine() const;              // "AMD EPYC, 2 cores, AVX3_DL, Linux 6.1"
    // whatever its system
    bool same_machine(const Provenance& o) const {
        return cpu == o.cpu && cores == o.cores && vectors == o.vectors;
    }
};

struct Results {
    std::string name;
    Provenance provenance;
    study::Cells cells;
    store::Table maps, boundaries;  // empty where the file is absent
    store::Table shown;             // cells.csv
};

// Throws UsageError where there is no manifest.json, no cells or maps, or a file cannot be read.
Results read_results(const std::filesystem::path&);

// ---- The rules

enum class Turn { same, moved, better, worse };
const char* name_of(Turn);

// Of a cell in both folders; what one side lacks is NaN there. `part`: of a figure, with "" the
// headline's tap.
Turn turn_of(const study::Column&, const study::TabledCell& before, const study::TabledCell& after);
Turn turn_of_fact(const std::string& name, const study::TabledCell& before,
                  const study::TabledCell& after);
Turn turn_of(double study::Figure::*part, std::size_t measure, const std::string& tap,
             const study::TabledCell& before, const study::TabledCell& after);

// ---- What changed

struct Finding {
    Turn turn;
    std::string row;     // what names it: "tanpura_c3_release modal_two_point 44100 Hz"
    std::string column;  // "error_l2_50ms", "cost_s_per_s", "outcome"
    std::string before, after;
    // what the numbers do not say; of a cost: how many times, and of how many cells
    std::string detail;
};

struct Only {  // what one of the folders has alone
    std::vector<std::string> before, after;
};

struct Difference {
    // of what both have; those of a row stand together, headline columns first
    std::vector<Finding> findings;
    Only cells, columns, points, boundaries;
    std::vector<std::pair<const char*, const Only*>> alone() const {  // each kind by its name
        return {{"cells", &cells},
                {"columns", &columns},
                {"points", &points},
                {"boundaries", &boundaries}};
    }
    std::string references;          // that they are others, and how; "": they are the same
    std::vector<std::string> notes;  // what could not be compared, and why
    int cells_in_both = 0;
    int to_the_last_digit = 0;  // cells of these, all fields but costs
    int compared = 0;           // fields

    int count(Turn) const;
    int missing() const;  // cells and points that are no longer there
    bool worse() const { return count(Turn::worse) > 0 || missing() > 0; }
    bool nothing() const;  // no finding, and nothing that one has alone
};

// Throws UsageError where no row is in both.
Difference difference(const Results& before, const Results& after);

// of each kind
std::string text_of(const Difference&, const Results& before, const Results& after,
                    std::size_t most_lines = 20);
std::string json_of(const Difference&, const Results& before, const Results& after);

// For difference.cpp alone.
struct Pair {  // what both have
    std::string name;
    std::size_t before, after;  // rows of the two tables
};
void compare_costs(const Results& before, const Results& after, const std::vector<Pair>&,
                   Difference&);

}  // namespace jvari::bench::suite
