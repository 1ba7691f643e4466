// The scene's start and others like it. A model that is trimmed by one start is verified by another, so that it is not tuned to one.
#pragma once

#include <string>

#include "scenes/scene.hpp"

namespace jvari::bench::trim {

constexpr int starts = 5;
// 0: the scene's own. Further ones have another shape or place, and between six and nine tenths of its size.
Scene started(Scene, int start);
std::string name_of_start(const Scene& started);  // of its first string that is set in motion

}  // namespace jvari::bench::trim
