// What a suite measures of a cell beside compare's errors and cost and the spectrogram: rows, made of the cell's accuracy run by one
// function and gathered over all cells into a file of the facet's name.
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

struct RowFacet {
    Facet facet;
    store::Table (*rows)(const MeasuredCell&);  // may come without rows; repeats bit for bit
    // Lays what was gathered into the folder of the suite in another form than <facet>.csv.
    void (*write)(const std::filesystem::path& folder, const store::Table& gathered) = nullptr;
};
std::span<const RowFacet> row_facets();

}  // namespace jvari::bench::suite
