// Limit of a reference's run whose size nobody asked for: a minute to show that it ends within ten.
#pragma once

#include <algorithm>

#include "bench/study/reference.hpp"

namespace jvari::bench::study {

inline TimeLimit first_run(double at_most) { return {std::min(at_most, 600.0), 60}; }

}  // namespace jvari::bench::study
