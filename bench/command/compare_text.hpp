// The table of a comparison for the terminal.
#pragma once

#include <string>

#include "bench/store/records.hpp"

namespace jvari {

std::string headline_text(const Table& cells);  // the front marked, and what is not to be trusted

}  // namespace jvari
