// Observed order of convergence of each scheme, per window and tap: the rows of cells.csv fitted over their rates
// (analysis/convergence.hpp).
#pragma once

#include "bench/store/records.hpp"

namespace jvari::bench::compare {

// Columns scene, <swept keys>, scheme, options, modes, tap, window, order, half_width (of the 95 % interval; empty with two points),
// points, from_hz, to_hz. A row per series of two rates or more. Left out of a fit: failed cells, errors of 1 or more (nothing of the
// waveform is right) and errors no larger than their noise floor or than what the reference is certain to. `modes` is empty where it
// changes with the rate, as a grid does. `scene`: its name where the rows do not say (compare's).
store::Table convergence_of(const store::Table& cells, const std::string& scene = "");

}  // namespace jvari::bench::compare
