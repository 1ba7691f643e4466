// Cause of a run's error, if a single cause explains most of the error.
#pragma once

#include <string>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::study {

// Cause at a tap, from the instant `from` [s] on: the first in this list that explains the error.
//   "stands still from row 4410 on, 0.1 s"
//   "is 1.1 times too large"
//   "is off by +0.012 N throughout, an offset"
//   "comes 3.00 rows late, 68 us"
//   free string     "sounds an octave low", "is out of tune, 3.0 cents flat: ...", "decays too
//                   slowly by 2 1/s: ..." and "has 20 partials"
//   other strings   tuning and decay over the first 50 ms
// Returns "" if no cause explains half the error (a factor or an offset nine tenths, a delay four
// fifths), or if the error is below 1 %.
std::string cause_of(const Scene&, const Trace& run, const Trace& reference, int tap, double from);

// Beginning of a cause that may be growth: only the energy of the scene tells decay from growth.
inline constexpr const char* too_slowly = "decays too slowly";

}  // namespace jvari::bench::study
