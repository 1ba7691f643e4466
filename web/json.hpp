// What the page is told, as JSON.
#pragma once

#include <string>

#include "analysis/cheapest.hpp"
#include "scenes/scene.hpp"
#include "schemes/run.hpp"

namespace jvari::web {

// schemes and references with their options
std::string list_text();
// what is drawn and moved of it
std::string scene_text(const Scene&);
// its modes, contacts, thread, pluck and taps as arrays
std::string problem_text(const Scene&, const Settings&);
// how it ended and is judged, its cost here, its facts
std::string run_text(const Run&, const Scene&, int modes, Balance promised);
std::string choice_text(const Choice&);  // by places

}  // namespace jvari::web
