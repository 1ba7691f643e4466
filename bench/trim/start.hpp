// The scene's start and others of another family: higher modes, a sharp triangle near an end (rounded as by a plectrum), a pluck elsewhere.
// A model that is trimmed by one start is verified by the others, so that it is not tuned to one.
#pragma once

#include <string>

#include "scenes/scene.hpp"

namespace jvari::bench::trim {

constexpr int starts = 5;
// 0: the scene's own. 1: sharp and near an end. 2: a higher mode. Further ones are elsewhere. Between six and nine tenths of its size.
Scene started(Scene, int start);
std::string name_of_start(const Scene& started);  // of its first string that is set in motion

}  // namespace jvari::bench::trim
