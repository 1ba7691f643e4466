// Observed order of convergence of each scheme, per window and tap: the rows of cells.csv fitted
// over their rates (analysis/convergence.hpp).
#pragma once

#include "bench/store/cell_rows.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::compare {

// Columns scene, <swept keys>, scheme, options, modes, tap, window, order, half_width (of the 95 %
// interval; empty with two points), points, from_hz, to_hz. A row per series of two rates or more
// that can tell (fall_over_rates). `modes` is empty where it changes with the rate, as a grid does.
store::Table convergence_of(const store::Table& cells);

}  // namespace jvari::bench::compare
