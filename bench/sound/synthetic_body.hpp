// A made-up body, for the measured responses of tanpuras are not published: what van Walstijn et al. 2016, fig. 5, describe in words.
//
// A simply supported plate, its lowest mode at 200 Hz, driven where the bridge or the nut stands; each mode loses f/30 a second. What
// lies below 200 Hz is taken away by a high pass of second order. Synthetic: no instrument has it.
#pragma once

#include <vector>

namespace jvari::bench::sound {

enum class BodyEnd { bridge, nut };
constexpr double synthetic_rate = 44100;  // [Hz]

// 2048 rows at 44.1 kHz; the strongest mode of the bridge's answers a force with as much pressure [1/1].
std::vector<double> synthetic_response(BodyEnd);

}  // namespace jvari::bench::sound
