// Which scheme is the cheapest that is as accurate as asked: 10 %, 1 % and 0.1 % of the waveform, 3
// dB and 1 dB of the third octaves.
#pragma once

#include "bench/store/records.hpp"

namespace jvari::bench::compare {

// From the rows of cells.csv. Columns scene, <swept keys>, measure (a column of cells.csv), target,
// status, run, scheme, options, rate, modes, error, bound, cost_s_per_s, ties, perhaps,
// as_published, why. A row per scene and target.
//   A cell meets a target where error and certificate together (bound.hpp) do; third octaves have
//   no certificate and count as measured.
//   status:  found; none; not_known: no cell meets it, and of some neither that it does nor that it
//            does not is certain.
//   run:     the cell found as a text (run_name). ties: other schemes with a cell that meets the
//            target and whose quartiles of cost touch, the cheapest such cell of each. perhaps:
//            other schemes with a cheaper cell (not_known: any cell) of which it is not certain.
//   as_published: where the cell found has matched compliance, the cheapest without it, its error
//   and cost; or "none".
//   why:     of what is found by third octaves, that the uncertainty of the reference is unknown
//            where it is; of not_known, what the
//   reference is known to, and by which other taps it is known; of none, for a waveform, what
//   stands in the way (diagnosis.hpp).
// Only cells that are timed and trusted count. The waveform's measure is the headline error of the
// scene. A control is known to be wrong somewhere: it is named only where it was asked to compete.
enum class Controls { stand_beside, compete };
store::Table cheapest_of(const store::Table& cells, Controls = Controls::stand_beside);
// trusted, and no control that stands beside
bool may_win(const store::Table& cells, std::size_t row, Controls);

std::string goal_name(const store::Table& cheapest, std::size_t row);  // "10 %", "3 dB"
// for the terminal; "" without rows
std::string cheapest_text(const store::Table& cheapest);

}  // namespace jvari::bench::compare
