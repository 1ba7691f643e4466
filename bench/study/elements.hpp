// What a part of a scene costs: the scene beside the same scene without it, timed in one interleaved run.
#pragma once

#include <span>
#include <string>

#include "scenes/scene.hpp"

namespace jvari::bench::study {

enum class Element { strings, thread, contact, losses, stiffness, taps, body, probe, radiation };
std::span<const Element> elements();
const char* name_of(Element);
bool is_added(Element);  // the probe and the radiation: they are not of the scene, they are on while it is timed

// The column `element` of tables: "-thread" is the scene without its thread, "+probe" the scene with the energy probe on, "+radiation" with
// the forces at its bridge and nut sent through its body after the run, "" the scene.
std::string change_of(Element);

// The scene without its strings but the first, threads, barriers (each with the taps of its force), losses of the strings, bending
// stiffness, taps but the first, or body; what is_added leaves it as it is.
// Throws UsageError where the scene has nothing of it: it would cost nothing, and the clock would say otherwise.
Scene without(Element, Scene);

}  // namespace jvari::bench::study
