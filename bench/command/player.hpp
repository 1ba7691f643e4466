// Plays a run into a .wav file with 24 bits, with the largest sample 1 dB below full scale.
//
// With a body (van Walstijn et al. 2016, Section 4.4): the left channel is the driving force of all
// strings, filtered by the response at the bridge. The right channel is the force on the nut,
// filtered by the response at the nut. A body with one response gives one channel.
//
// Without a body: the driving force if a string has a barrier or a thread, else the force on the
// nut. High frequencies are lowered as in radio: a first-order low pass at 3183 Hz, the de-emphasis
// of 50 us. The reason is that no body radiates a force that is flat to 20 kHz.
//
// In both cases a first-order high pass at 20 Hz removes the steady part. There is no dither. The
// unprocessed signals go to .csv.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>
#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::command {

bool is_audio(const std::filesystem::path&);  // decided by the extension

Scene audible(Scene);  // replaces the taps by the taps to be played

// Plays a run of audible(scene) into a file; constructed before the run.
class Player {
public:
    // Throws UsageError for a path that cannot be written, a sound that does not fit the format, or
    // a body that cannot be read.
    Player(std::filesystem::path, const Scene&, double tap_rate);
    // Returns the level as text. Throws Unwritable.
    std::string write(const Trace&) const;

private:
    std::filesystem::path path_;
    std::vector<std::vector<double>> body_;  // response for each tap; empty: no body
};

// ---- Stages.

struct Played {
    std::vector<std::vector<double>> channels;  // relative to full scale 1
    // Value of full scale [N], with a body after its response; 0: silence.
    double full_scale = 0;
    double peak = 0, rms = 0;  // relative to full scale, over all channels
    long clipped = 0;          // samples beyond full scale
};
std::vector<double> without_body(std::span<const double> force, double rate);
std::vector<double> without_steady(std::span<const double> force, double rate);
Played levelled(std::vector<std::vector<double>> channels);
// "full scale 1.2 N, peak -1.0 dB, rms -20.3 dB, 0 samples clipped"
std::string level_text(const Played&);
// Throws Unwritable.
void write_audio(const std::filesystem::path&, double rate,
                 const std::vector<std::vector<double>>& channels);

// ---- The body

// Reads the impulse response from a .wav file with one channel, at `rate` [Hz]. The file contains
// h[n] = h(n T) T, so its sum is the response to a steady force at any sample rate. A file with
// another sample rate is resampled by libsamplerate, and is delayed by 64 of its own rows. Throws
// UsageError naming `key`.
std::vector<double> impulse_response(const std::string& file, double rate, const std::string& key);

// Responses of the body for the taps it filters: the driving force and the force on the nut, summed
// over all strings. Throws UsageError.
std::vector<std::vector<double>> body_responses(const Scene&, double rate);

}  // namespace jvari::bench::command
