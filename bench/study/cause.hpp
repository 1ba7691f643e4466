// The cause of a run's error, where one thing explains most of it.
#pragma once

#include <string>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::study {

// Of a tap, from the instant `from` [s] on, in this order: "is out of tune, 3.0 cents flat: ...",
// "comes 3.00 rows late, 68 us", "is 1.1 times too large". "" where none of these explains half of
// the error (of the last two, nine tenths), or where it is below 1 %.
std::string cause_of(const Scene&, const Trace& run, const Trace& reference, int tap, double from);

}  // namespace jvari::bench::study
