// ro-crate-metadata.json of a folder of results: what an archive asks of it, authors, licence, date and parts, by RO-Crate 1.1
// (https://w3id.org/ro/crate/1.1). Authors and licence are those of CITATION.cff.
#pragma once

#include <filesystem>
#include <string>

namespace jvari::bench::report {

inline constexpr const char* crate_file = "ro-crate-metadata.json";

// From manifest.json and the files that lie in the folder now.
std::string crate_of(const std::filesystem::path& folder);
void write_crate(const std::filesystem::path& folder);

}  // namespace jvari::bench::report
