// What a body lets out of the force that strings put on one end of it: van Walstijn et al. 2016,
// Sections 3.3 and 4.4.
//
// The body is a filter of a trace, by a measured response of sound pressure to force. It takes
// nothing back to the strings.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari::bench::sound {

// The impulse response in a .wav of one channel, at `rate` [Hz]. A file holds h[n] = h(n T) T, so
// that its sum is the response to a steady force at any rate. One of another rate is resampled by
// libsamplerate, and comes later by 64 rows of its own. Throws UsageError naming `key`.
std::vector<double> impulse_response(const std::string& file, double rate, const std::string& key);

// The body's response for each tap that it answers: the driving force, and the force on the nut, of
// all strings. Throws UsageError.
std::vector<std::vector<double>> body_responses(const Scene&, double rate);

}  // namespace jvari::bench::sound
