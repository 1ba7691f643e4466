// What a table of cells warns of: a clock that cannot be believed, and runs in which matched
// compliance did harm.
#pragma once

#include <string>
#include <vector>

#include "bench/store/records.hpp"

namespace jvari::bench::compare {

// Half the distance of the quartiles of the cost over its median, of the middle one of the timed
// cells; NaN where none was timed.
double median_spread(const store::Table& cells);
// Above a fifth: the sentence that says so, else "".
std::string busy_text(const store::Table& cells);
// Of cells that differ in nothing but compliance=own and matched: those in which a tap's error,
// over the headline's window, is surely more than 1.2 times that of its own sibling; the sentence
// that counts them and names the worst, else "".
std::string harm_text(const store::Table& cells);

std::vector<std::string> warnings_of(const store::Table& cells);  // all of these that say something

}  // namespace jvari::bench::compare
