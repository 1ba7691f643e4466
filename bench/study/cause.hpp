// The cause of a run's error, where one thing explains most of it.
#pragma once

#include <string>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::study {

// Of a tap, from the instant `from` [s] on; the first that explains the error, in this order:
// "stands still from row 4410 on, 0.1 s", "is 1.1 times too large", "is off by +0.012 N throughout,
// an offset", "comes 3.00 rows late, 68 us", of a free string "sounds an octave low", "is out of
// tune, 3.0 cents flat: ...", "decays too slowly by 2 1/s: ..." and "has 20 partials", of any other
// its tuning and decay over the first 50 ms. "" where none explains half of the error (a factor or
// an offset nine tenths, a delay four fifths), or where the error is below 1 %.
std::string cause_of(const Scene&, const Trace& run, const Trace& reference, int tap, double from);

// How a cause begins that may be growth: who knows the energy of the scene says which it is.
inline constexpr const char* too_slowly = "decays too slowly";

}  // namespace jvari::bench::study
