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
};

}  // namespace jvari::bench::store
