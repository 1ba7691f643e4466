// The rows that charts draw, as JSON text.
#pragma once

#include <string>
#include <vector>

#include "bench/charts.hpp"

namespace jvari {

std::string chart_cells(
    const WorkPrecision&);  // one object per cell that ran: scheme, rate, label, every error and cost that can be chosen
std::string chart_fronts(const WorkPrecision&);  // the Pareto front of every choice of error and cost: decided here and not in the page
double floor_of(const WorkPrecision&, const std::string& error);  // NaN: not known
std::vector<std::string> drawn_schemes(const Table& cells);       // in the order of the rows

}  // namespace jvari
