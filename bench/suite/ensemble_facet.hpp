// Is a cell statistically the reference, where waveforms forget their start? Scheme and reference each run 32 times, every initial shape
// and pluck scaled by 1 + 1e-4 u with u between -1 and 1, no start twice; analysis/ensemble.hpp tells the two apart, trait by trait. No
// string is let go twice alike to 1e-4. Much less of a spread is not forgotten within a quarter of a second: by 1e-6 the reference is told
// from itself where its start moves by 1e-5.
// The reference has the modes of the cell, or reference_modes where the suite says a number; it is the first that represents the scene.
#pragma once

#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

constexpr int ensemble_runs = 32;
constexpr double ensemble_spread = 1e-4;  // of the start

// Columns kind, where, reference, candidate, p, apart: a row for each trait, and one first with kind "any" whose `apart` counts those
// that are. None where no reference represents the scene, or a run does not reach its end.
store::Table ensemble_rows(const MeasuredCell&);

// From ensemble.csv: of each scheme on each problem the rate from which on nothing is told apart; "" without rows.
std::string ensemble_text(const store::Table&);

}  // namespace jvari::bench::suite
