// Strings that will not sound.
#pragma once

#include "bench/store/system/listener.hpp"
#include "scenes/scene.hpp"

namespace jvari::bench::compare {

// Warns of each string that nothing sets in motion before the scene ends: no start, no pluck, no other string through a moving body.
void note_silent_strings(const Scene&, const store::Listener&);

}  // namespace jvari::bench::compare
