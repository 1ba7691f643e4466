// Where compliance=matched may err by more than compliance=own: what the facts of the cells say (schemes/contact/matching_facts.hpp).
#pragma once

#include <string>

#include "bench/store/records.hpp"

namespace jvari::bench::compare {

// A line for each cause that a cell tells, with the cell that tells it loudest; "" where none does.
std::string matching_note(const store::Table& cells);

// ---- How far the clock can be believed: a busy machine scatters.

// Half the distance of the quartiles of the cost over its median, of the middle one of the timed cells; NaN where none was timed.
double median_spread(const store::Table& cells);
// Above a fifth: the sentence that says so, else "".
std::string busy_text(const store::Table& cells);

}  // namespace jvari::bench::compare
