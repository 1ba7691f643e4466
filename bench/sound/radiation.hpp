// What a body lets out of the force that strings put on one end of it: van Walstijn et al. 2016, Sections 3.3 and 4.4.
//
// The body is a filter of a trace, by a measured response of sound pressure to force. It takes nothing back to the strings.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/resonators.hpp"
#include "scenes/scene.hpp"

namespace jvari::bench::sound {

// The impulse response in a .wav or .flac of one channel, at `rate` [Hz]. A file holds h[n] = h(n T) T, so that its sum is the response to
// a steady force at any rate. One of another rate is resampled by libsamplerate, and comes later by 64 rows of its own. Throws UsageError
// naming `key`.
std::vector<double> impulse_response(const std::string& file, double rate, const std::string& key);

class Radiation {
public:
    // By convolution, or by that many second-order sections fitted to the response (0: by convolution).
    Radiation(std::vector<double> response, double rate, int sections);
    std::vector<double> operator()(std::span<const double> force) const;
    double misfit() const { return misfit_; }  // of the sections, misfit_db(); 0 by convolution

private:
    std::vector<double> response_;
    std::optional<Resonators> sections_;
    double misfit_ = 0;
};

// The body's filter for each tap that it answers: the driving force, and the force on the nut, of all strings. Throws UsageError.
struct RadiatingTap {
    int tap;
    Radiation filter;
};
std::vector<RadiatingTap> radiating_taps(const Scene&, double rate);

}  // namespace jvari::bench::sound
