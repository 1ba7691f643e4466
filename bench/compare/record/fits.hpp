// Observed order of convergence of each scheme, per window and tap: the rows of cells.csv fitted over their rates
// (analysis/convergence.hpp).
#pragma once

#include "bench/store/cell_rows.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::compare {

// Columns scene, <swept keys>, scheme, options, modes, tap, window, order, half_width (of the 95 % interval; empty with two points),
// points, from_hz, to_hz. A row per series of two rates or more that can tell (fall_over_rates). `modes` is empty where it changes with
// the rate, as a grid does.
store::Table convergence_of(const store::Table& cells);

// ---- What the cost of a step grows with, and what each element of a scene adds to it: the timed rows of cells.csv, compared with each
// other.

// Columns scene, <swept keys>, scheme, options, at (what was held: "44100 Hz, 133 modes"), what, x, ns_per_step, ns_lower, ns_upper (median
// and quartiles, of processor time where it was taken), exponent, exponent_half_width, extra_ns, extra_lower, extra_upper.
//   what = modes, rate, contacts: rows that differ in it alone, of two values or more; contacts are the scheme's own count of contact
//          points, varied by one swept key. ns ~ x^exponent by least squares on logarithms, half width of the 95 % interval (empty with
//          two).
//   what = the name of an element: cells of a set with `elements` (elements.hpp). ns_per_step is that of the scene without it (probe and
//          radiation: with it), extra_ns what it adds to the step; between extra_lower and extra_upper by the quartiles of both.
// Where cells were timed on several machines a column `machine` stands before `at`: no fit and no difference is of two machines.
// Rows that did not reach their end, or were not timed, have no place in it. `sets`: rows of one set of a suite, which were timed in one
// interleaved run; rows of different sets are not compared. None where nothing was varied.
store::Table scaling_of(const store::Table& cells, const std::vector<store::Rows>& sets);

}  // namespace jvari::bench::compare
