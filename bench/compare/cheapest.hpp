// Which scheme is the cheapest that is as accurate as asked: 10 %, 1 % and 0.1 % of the waveform, 3 dB and 1 dB of the third octaves.
#pragma once

#include "bench/store/records.hpp"

namespace jvari {

// From the rows of cells.csv. Columns scene, <swept keys>, measure (a column of cells.csv), target, scheme, options, rate, modes, error,
// cost_s_per_s, ties: the other schemes with a cell that meets the target and whose quartiles touch. A row per scene and target; empty from
// `scheme` on where no cell gets there. Only cells that are ok, timed, and have no flags against them count. `waveform`: which window;
// where a scene has none of it the next shorter one, else the whole run.
Table cheapest_of(const Table& cells, const std::string& waveform = "error_l2_50ms", const std::string& scene = "");

std::string goal_name(const Table& cheapest, std::size_t row);  // "10 %", "3 dB"
std::string cheapest_text(const Table& cheapest);               // for the terminal; "" without rows

}  // namespace jvari
