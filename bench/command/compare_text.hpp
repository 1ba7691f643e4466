// The table of a comparison for the terminal.
#pragma once

#include <string>

#include "bench/store/records.hpp"

namespace jvari::bench::command {

std::string headline_text(const store::Table& cells);  // the front marked, and what is not to be trusted

}  // namespace jvari::bench::command
