// The table of a comparison for the terminal.
#pragma once

#include <string>

#include "bench/store/records.hpp"

namespace jvari::bench::command {

// The front marked, and what is not to be trusted; in lines of that width, cost and headline error always.
std::string headline_text(const store::Table& cells, std::size_t width);

}  // namespace jvari::bench::command
