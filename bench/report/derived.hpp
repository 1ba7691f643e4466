// What the page joins with the folder's tables: what the program says of each cell, each scene and
// each line. Judgements and statistics are made here, once; the page's JavaScript looks them up and
// draws them.
#pragma once

#include <map>
#include <string>

#include "bench/report/results.hpp"

namespace jvari::bench::report {

// judged:   of each cell, trusted, may_win, run (its name in a sentence),
//           line (its series beside the front; none where another of its scheme's numbers of modes
//           is better)
// bounds:   row, column, shown, text: errors that are no more than bounded (compare/bound.hpp)
// scenes:   problem, headline, certificate (of its first cell), spread and busy (of its clock)
// cheapest: problem, then what compare::cheapest_of says, and goal ("10 %")
// fronts:   row, error, cost: the cells on the front of each error and cost
// orders:   problem, series, error, order, half_width, points: as observed over the rates
std::map<std::string, store::Table> derived_tables(const Results&);

}  // namespace jvari::bench::report
