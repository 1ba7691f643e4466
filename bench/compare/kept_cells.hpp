// Cells of a comparison as files, DIR/cells/<id>.json: what is stopped goes on where it was. The errors of a cell are kept, not its cost,
// for all are timed in one interleaved run. A cell that refuses is not kept: it refuses again at once.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/compare/compare_plan.hpp"

namespace jvari::bench::compare {

struct KeptCells {
    std::filesystem::path folder;                 // "": nothing is kept
    bool resume = false;                          // what lies there is read back
    std::atomic<int> kept = 0, of = 0, read = 0;  // how many lie there, of how many; of those that were read
};

// JSON: all that a cell's numbers depend on.
std::string identity_of(const Cell&, const Reference& truth, const Reference& model, const Scene&);
std::string json_of(const Cell&, const std::string& identity);
bool read_cell(const std::filesystem::path&, const std::string& identity, Cell& into);  // false: there is none that is whole

Comparison compare(const CompareRequest&, const Catalogue&, const store::Listener&, KeptCells&);

}  // namespace jvari::bench::compare
