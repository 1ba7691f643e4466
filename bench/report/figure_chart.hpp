// Figures of a suite as Vega-Lite specifications, and as the SVG files that a suite writes: figure-NAME.svg.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/store/records.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/columns.hpp"
#include "bench/suite/figure_file.hpp"
#include "bench/suite/suite_file.hpp"

namespace jvari::bench::report {

// Of lines, points or a band over the rows of a table. Throws UsageError for a column that is not there and where no row is left.
std::string figure_spec(const suite::Figure&, const store::Table&);

struct DrawnFigure {
    std::string file, svg;
};
// What cannot be drawn is said as a note, with the reason, and left out.
std::vector<DrawnFigure> draw_figures(const suite::Suite&, const study::Plan&, const std::vector<study::Record>&, const store::Table& cells,
                                      const store::Listener&);
// Of a folder whose manifest names a suite of the library: its figures again, of the tables that lie there. Spectrograms have none.
std::vector<DrawnFigure> redraw_figures(const std::filesystem::path& folder, const store::Listener&);

}  // namespace jvari::bench::report
