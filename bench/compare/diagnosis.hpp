// Why no cell is as accurate as asked, and what can be judged instead: one sentence where a table would say "none".
//
// The series with the least error tells how errors fall with the rate. Where they fall by a power that is known to be one, the rate that
// would do is extrapolated, and called so. Else the sentence says for how long waveforms stay together, what noise and modes allow, and
// which other measure finds a cell.
#pragma once

#include <string>

#include "bench/store/cell_rows.hpp"

namespace jvari::bench::compare {

// `rows`: of one scene, timed and trusted; `measure`: an error column of relative L2; `most`: what none of them is within.
std::string why_none(const store::Table& cells, const store::Rows& rows, const std::string& measure, double most);

}  // namespace jvari::bench::compare
