// Figures of a suite as Vega-Lite specifications, and as the SVG files that a suite writes: figure-NAME.svg.
#pragma once

#include <string>
#include <vector>

#include "bench/store/console.hpp"
#include "bench/store/records.hpp"
#include "bench/suite/figure_file.hpp"
#include "bench/suite/suite_record.hpp"

namespace jvari {

// Of lines, points or a band over the rows of a table. Throws UsageError for a column that is not there and where no row is left.
std::string figure_spec(const Figure&, const Table&);

struct DrawnFigure {
    std::string file, svg;
};
// What cannot be drawn is said as a note, with the reason, and left out.
std::vector<DrawnFigure> draw_figures(const Suite&, const SuitePlan&, const std::vector<SuiteRecord>&, const Table& cells, const Console&);

}  // namespace jvari
