// The table of a comparison for the terminal.
#pragma once

#include <string>

#include "bench/store/records.hpp"

namespace jvari {

std::string headline_text(const Table& cells, const std::string& error_column);  // the front marked

}  // namespace jvari
