// The Pareto front of cost and error, where a difference that is no finding decides nothing.
#pragma once

#include <span>
#include <vector>

#include "bench/store/cell_rows.hpp"

namespace jvari::bench::compare {

struct Point {
    // median and quartiles; all the same for a cost that does not scatter
    double cost, cost_lower, cost_upper;
    // brought up to its noise floor and certificate by the caller: what lies below is a tie
    double error;
    double certificate = 0;  // the error is known to so much
};

// A point is on the front where no other is surely better: another whose error is less by more than
// both certificates at a cost that is less or a tie, or with an error no larger at a cost that is
// surely less. A point without a finite cost and error is never on it.
std::vector<bool> pareto_front(std::span<const Point>);

// Which of the rows of cells.csv are on the front of an error column and a cost column: of those
// that are trusted and whose error is known.
std::vector<bool> pareto_front(const store::Table& cells, const store::Rows&,
                               const std::string& error, const std::string& cost);

// The table with the column `pareto` after what the clock said: 1 for the rows on the front of
// `cost_s_per_s` and the headline error of their scene at their point of a sweep.
store::Table with_front(store::Table cells);

}  // namespace jvari::bench::compare
