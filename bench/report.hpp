// From cells.csv and manifest.json of a folder: work_precision.svg and report.html beside them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/console.hpp"

namespace jvari {

// Returns the names of the files written. Without node or its packages the page comes with tables alone, the picture not at all, and a note
// says what is missing. Throws UsageError where the folder does not hold the two files or they cannot be read.
std::vector<std::string> write_report(const std::filesystem::path& folder, const Console&);

}  // namespace jvari
