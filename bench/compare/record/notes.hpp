// How far the clock can be believed: a busy machine scatters.
#pragma once

#include <string>

#include "bench/store/records.hpp"

namespace jvari::bench::compare {

// Half the distance of the quartiles of the cost over its median, of the middle one of the timed cells; NaN where none was timed.
double median_spread(const store::Table& cells);
// Above a fifth: the sentence that says so, else "".
std::string busy_text(const store::Table& cells);

}  // namespace jvari::bench::compare
