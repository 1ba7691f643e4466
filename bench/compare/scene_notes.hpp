// What a reader of a scene is told before it is run: what its strings are, and what looks wrong.
#pragma once

#include <string>

#include "analysis/judgement.hpp"
#include "bench/store/system/listener.hpp"
#include "scenes/scene.hpp"

namespace jvari::bench::compare {

// "f1 = 82.4 Hz (E2), tension 74.3 N, inharmonicity 1.2e-04"
std::string tuning_text(const String&);

// Where a scene has barriers and its run never touched one: that, and what to look at. ""
// elsewhere, and where the run does not say.
std::string untouched_text(const Scene&, const Figures& run);

// Warns of values that look like another unit than SI, and of a string that
// nothing sets in motion before the scene ends: no start, no pluck, no barrier that presses it, no
// other string through a moving body.
void note_scene(const Scene&, const store::Listener&);

}  // namespace jvari::bench::compare
