// A trimmed scene as files: trimmed.toml, needs.csv, path.csv, manifest.json.
#pragma once

#include "bench/store/records.hpp"
#include "bench/trim/trim.hpp"

namespace jvari::bench::trim {

store::Table needs_table(const Trimmed&, const Judge&);
store::Table path_table(const Trimmed&, const Judge&);
// that runs the trimmed model: "jvari run trimmed.toml --scheme ..."
std::string command_of(const Trimmed&, const std::string& file);
std::string trimmed_toml(const Trimmed&, const Judge&);
nlohmann::ordered_json manifest_of(const Trimmed&, const Judge&, const Request&);

}  // namespace jvari::bench::trim
