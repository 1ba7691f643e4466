// What a suite can measure of a cell. A facet beside compare's errors and cost and the spectrogram makes rows of the cell's accuracy run by
// one function, and they are gathered over all cells into a file of its name. A new one is a file of its own and a line of facets(); where
// a set has to describe it, its file declares a table of the set for that too.
#pragma once

#include <filesystem>
#include <span>

#include "bench/store/records.hpp"
#include "bench/suite/suite_file.hpp"
#include "schemes/scheme.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::suite {

struct MeasuredCell {  // a cell whose accuracy run reached its end or its failure
    const Scene& scene;
    const Descriptor& scheme;
    const Settings& settings;
    const Trace& trace;
    const Trace* reference;  // on the same rows; nullptr where there is none
    int tap;                 // that the set of cells names, else the scene's first
    const CellSet& set;
};

struct Facet {
    const char* name;
    const char* meaning;
    store::Table (*rows)(const MeasuredCell&) = nullptr;  // may come without rows; repeats bit for bit
    // Lays what was gathered into the folder of the suite in another form than <name>.csv.
    void (*write)(const std::filesystem::path& folder, const store::Table& gathered) = nullptr;
    store::Key<FigureFacets> (*described)() = nullptr;  // a table of the set, of the facet's name, that must stand where it is measured
};
std::span<const Facet> facets();

}  // namespace jvari::bench::suite
