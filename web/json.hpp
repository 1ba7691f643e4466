// JSON texts for the page.
#pragma once

#include <string>

#include "analysis/cheapest.hpp"
#include "scenes/scene.hpp"
#include "schemes/run.hpp"

namespace jvari::web {

// schemes and references with their options
std::string list_text();
// parts of the scene to draw and to move
std::string scene_text(const Scene&);
// modes, contacts, thread, pluck and taps as arrays
std::string problem_text(const Scene&, const Settings&);
// outcome, judgement, cost on this machine, facts
std::string run_text(const Run&, const Scene&, int modes, Balance promised);
std::string choice_text(const Choice&);  // by places

}  // namespace jvari::web
