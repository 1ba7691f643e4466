// Where compliance=matched may err by more than compliance=own: what the facts of the cells say (schemes/contact/matching_facts.hpp).
#pragma once

#include <string>

#include "bench/store/records.hpp"

namespace jvari::bench::compare {

// A line for each cause that a cell tells, with the cell that tells it loudest; "" where none does.
std::string matching_note(const store::Table& cells);

}  // namespace jvari::bench::compare
