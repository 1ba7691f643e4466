// What a part of a scene costs: the scene beside the same scene without it, timed in one interleaved run.
#pragma once

#include <span>
#include <string>

#include "scenes/scene.hpp"

namespace jvari::bench::compare {

enum class Element { thread, contact, stiffness, taps, probe };
std::span<const Element> elements();
const char* name_of(Element);

// The column `element` of tables: "-thread" is the scene without its thread, "+probe" the scene with the energy probe on, "" the scene.
std::string change_of(Element);

// The scene without its threads, barriers (each with the taps of its force), bending stiffness, or taps but the first; the probe is not of
// the scene and leaves it as it is.
// Throws UsageError where the scene has nothing of it: it would cost nothing, and the clock would say otherwise.
Scene without(Element, Scene);

}  // namespace jvari::bench::compare
