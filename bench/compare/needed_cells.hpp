// Which of the cells that were sought are worth a whole run and a clock.
//
// All run over the headline's window first. A cell is left out where another that surely costs less
// does as well there: its error is larger by a tenth at most, and it keeps every accuracy of the
// table of the cheapest that the cell keeps. It is left out as well where such another keeps all of
// them, or where it failed or has flags and its modes were not named. So no cell that is left out
// could be the cheapest for a waveform.
//
// Surely less: a thirty-second of the steps times the state; of more modes than a form of a scheme
// takes unasked, fewer or as many modes at a rate that is no higher. No clock is asked, so that the
// same cells are run on every machine.
#pragma once

#include <vector>

#include "bench/study/cell.hpp"

namespace jvari::bench::compare {

// Cells that were run over the window, their headline errors and what the reference is uncertain by
// there (NaN: unknown, counts as 0). Those that are not needed get needed = false and a reason.
void mark_needed(std::vector<study::Cell>&, const std::vector<double>& errors, double certificate);

}  // namespace jvari::bench::compare
