// From what lies in a folder of compare or of suite: report.html beside it, and each of its charts as a picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::report {

// Returns the names of the files written. Without node or its packages the page comes with tables and sounds alone, the pictures not at
// all, and a note says what is missing. Throws UsageError where the folder does not hold results or they cannot be read.
std::vector<std::string> write_report(const std::filesystem::path& folder, const store::Listener&);

}  // namespace jvari::bench::report
