// Draws random valid scenes from a seed, small enough to run quickly.
//
// Nine in ten have the ordinary physics of instruments, the rest extreme values. The same seed
// gives the same scene on every machine, up to the last digits of std::pow: std::mt19937_64 is
// specified to the bit.
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
// One string with at most one lumped barrier without contact loss, and mostly a thread of any
// stiffness and damping, for 10 ms at 44.1 kHz: a scene for compliance=matched. It has the modes
// below 20 kHz, 8 to 150. `bar`: with a barrier, on a string whose bending carries all modes but
// the first few. `wide`: with a barrier of 1 to 6 cm.
enum class Matching { string, bar, wide };
RandomCase matching_case(std::uint64_t seed, Matching = Matching::string);

}  // namespace jvari::test
