// Reads a parsed document as a scene. validate() checks what depends on several values.
#pragma once

#include "scenes/document.hpp"
#include "scenes/scene.hpp"

namespace jvari {

Scene scene_of(const Document&);  // throws SceneFileError

}  // namespace jvari
