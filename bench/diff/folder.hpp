// What lies in a folder of compare or suite, as far as two such folders can be compared: a row for
// each cell, the modes' own pitches, maps.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/store/folder.hpp"

namespace jvari::bench::diff {

struct Made {                                 // by what, as manifest.json has it
    std::string commit, date;                 // commit: "unknown" outside git
    std::string compiler, flags, build;       // the program
    std::string cpu, cores, vectors, system;  // the machine
    std::string machine() const;              // "AMD EPYC, 2 cores, AVX3_DL, Linux 6.1"
    // whatever its system
    bool same_machine(const Made& o) const {
        return cpu == o.cpu && cores == o.cores && vectors == o.vectors;
    }
};

struct Folder {
    std::string name;
    Made made;
    store::Table cells;                         // errors and costs of a cell in one row
    store::Table dispersion, maps, boundaries;  // empty where the file is absent
    // a column in which errors.csv differs from cells.csv; "": none
    std::string altered;
};

// Throws UsageError where there is no manifest.json, no cells, errors or maps, or a file cannot be
// read.
Folder read_folder(const std::filesystem::path&);

// Rows by the text that names them: scene, swept keys, scheme, options and rate; the modes too
// where a table has several at one rate.
using Named = std::map<std::string, std::size_t>;
Named named_cells(const store::Table& cells, bool with_modes, bool with_scene);
bool modes_name(const store::Table& cells);  // two rows differ in their modes alone

// Rows by the values of these columns, "x=1 y=2"; where several have the same, the second is "...
// #2".
Named named_rows(const store::Table&, const std::vector<std::string>& columns);

}  // namespace jvari::bench::diff
