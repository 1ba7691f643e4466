// Charts as Vega-Lite specifications (https://vega.github.io/vega-lite), made here and drawn by vl2svg or in a page by vega-embed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/records.hpp"

namespace jvari {

struct Axis {
    std::string column, title;
};

struct WorkPrecision {
    std::string title, subtitle;
    Table cells;                                         // as compare writes them
    std::vector<Axis> errors, costs;                     // what a reader can choose between; the first of each is shown
    std::vector<std::pair<std::string, double>> floors;  // noise floor of an error column
    bool wide = false;                                   // fills its container (a page) in place of a fixed width
};

// Cost across, error up, both logarithmic: a line per scheme through its rates, the Pareto front behind, the noise floor as a band,
// failures at the upper edge. The signals `error_field` and `cost_field` choose the columns.
std::string work_precision_spec(const WorkPrecision&);

std::vector<Axis> error_axes(const Table& cells, const std::vector<std::string>& taps,
                             const std::string& first);  // those with a finite value
std::vector<Axis> cost_axes();

}  // namespace jvari
