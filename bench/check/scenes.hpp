// The scenes on which the contract is asked for, and what a feature of one can be changed to.
#pragma once

#include <vector>

#include "scenes/scene.hpp"

namespace jvari::bench::check {

// The C3 string of van Walstijn, Bridges & Mehes 2016, Table 1: alone and at rest, heard at its nut
// and at 0.3 m.
Scene string_at_rest();

constexpr double contract_tap_rate = 44100;  // [Hz]
constexpr int contract_modes = 40;
constexpr long contract_rows = 200;
constexpr double what_modes_leave_out = 5e-5;  // of the whole string, which a grid nears
constexpr double what_nodes_leave_out = 1e-2;  // of a force on a profile, at any rate

// the library and a few made here, each of contract_rows; read once
const std::vector<Scene>& contract_scenes();

// Scenes that need a feature and listen to the motion: two that need little else, then those above,
// with it where they are without.
std::vector<Scene> scenes_with(Feature);

// Short and smooth scenes that have between them every number of a scene, each of a size that is
// heard.
const std::vector<Scene>& scenes_of_numbers();

// The same scene with this one feature otherwise: another value of it, or none. A scheme that heeds
// the feature tells the two apart.
std::vector<Scene> otherwise(const Scene&, Feature);

}  // namespace jvari::bench::check
