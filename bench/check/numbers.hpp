// The numbers of a scene, from the schema of scene files: a key that the schema gains is found here
// by itself.
#pragma once

#include <optional>
#include <string>

#include "scenes/scene.hpp"

namespace jvari::bench::check {

struct Changed {
    std::string key;  // "string.0.barrier.1.height"
    Scene scene;
};

// The scene with its number `which` changed by a tenth, one that is 0 by a step; each column of a
// table is one number. Nothing beyond the last.
std::optional<Changed> changed(const Scene&, int which, bool down = false);

}  // namespace jvari::bench::check
