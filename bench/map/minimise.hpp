// A trial that fails, made as small as it still fails in the same way: delta debugging over what a scene and its settings are made of.
//
// Taken away one by one, in turn, until nothing more can be (scenes/reduction.hpp): strings, barriers, polarisation, pluck or initial shape
// (one of the two stays), thread, losses, bending stiffness, contact losses, an exponent other than 1; then duration, modes or the grid's
// intervals are shortened by halves, quarters ... down to single rows and modes. What is left is minimal step by step, not the smallest of
// all.
#pragma once

#include <functional>

#include "bench/map/trial.hpp"

namespace jvari::bench::map {

using Fails = std::function<bool(const Trial&)>;  // in the way that is to be kept; what it throws counts as no

Trial minimised(Trial, const Fails&);

}  // namespace jvari::bench::map
