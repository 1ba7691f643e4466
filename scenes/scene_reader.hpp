// A parsed document read as a scene; what is left to validate() is not looked at.
#pragma once

#include "scenes/document.hpp"
#include "scenes/scene.hpp"

namespace jvari {

Scene scene_of(const Document&);  // throws SceneFileError

}  // namespace jvari
