// A folder of results: its manifest and its tables. What cannot be read throws UsageError with the
// folder's name, the file and why.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/store/records.hpp"

namespace jvari::bench::store {

struct Folder {
    std::filesystem::path path;

    nlohmann::ordered_json manifest() const;
    Table table(const std::string& file) const;  // FILE.csv; empty where there is none

    // cells.csv; of a record, which has none, errors.csv with the costs of cost.csv behind it, cell
    // by cell. Tables of compare once did not name the cell: there the rows are the same. `whole`:
    // throws where a cost is of no row.
    Table cells(bool whole) const;
};

}  // namespace jvari::bench::store
