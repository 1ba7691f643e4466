// The rows that charts draw, as JSON text.
#pragma once

#include <string>
#include <vector>

#include "bench/report/charts.hpp"

namespace jvari::bench::report {

// One object per cell that ran: problem, series, rate, label, every error (as bound.hpp shows it) and cost that can be chosen;
// `at_most`: the errors that stand as a bound; `flags`: what speaks against it.
std::string chart_cells(const WorkPrecision&);
std::string chart_fronts(
    const WorkPrecision&);  // the Pareto front of every choice of problem, error and cost: decided here, not in the page
std::vector<std::string> drawn_series(const store::Table& cells);  // in the order of the rows
// "" where the cells are of one problem without a name.
const std::string& problem_of(const store::Table& cells, std::size_t row);
const std::string& series_of(const store::Table& cells, std::size_t row);

}  // namespace jvari::bench::report
