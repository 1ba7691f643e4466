// Scenes that nobody thought of: drawn from a seed, valid by construction or drawn again, small enough to run in a moment.
//
// Nine in ten are of ordinary physics, strings and obstacles of instruments; the rest reach for the ends of what a scene may say. The same
// seed gives the same scene on every machine, but for the last digits of std::pow: std::mt19937_64 is specified to the bit.
#pragma once

#include <cstdint>

#include "schemes/scheme.hpp"

namespace jvari::test {

struct RandomCase {
    std::uint64_t seed = 0;
    bool extreme = false;
    Scene scene;
    Settings settings;  // of a stepped scheme; a reference takes its modes and its tap rate
};
RandomCase random_case(std::uint64_t seed);
// One string with at most one lumped barrier that loses nothing, and mostly a thread of any stiffness and damping: what compliance=matched
// is for, in 10 ms at 44.1 kHz. The modes are those below 20 kHz, 8 to 150.
RandomCase matching_case(std::uint64_t seed);

}  // namespace jvari::test
