// What a player plays of a run, a .wav of 24 bit, the largest sample 1 dB below full scale.
//
// Through the body where the scene has one: the driving force of all strings by its response at the
// bridge on the left, the force on the nut by that at the nut on the right (van Walstijn et al.
// 2016, Section 4.4); a body of one response gives one channel. Without a body: the driving force
// where a string has a barrier or a thread, else the force on the nut, its highs lowered as radio
// lowers them (a low pass of first order at 3183 Hz, the de-emphasis of 50 us), for a force that is
// flat to 20 kHz is no sound that a body lets out. In both the steady part is taken away (a high
// pass of first order at 20 Hz). Left out: dither. The signals as they are go to .csv.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>
#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::command {

bool is_audio(const std::filesystem::path&);  // by its extension

Scene audible(Scene);  // with the taps that are played in place of its own

// What plays a run of audible(scene) into a file, made before the run.
class Player {
public:
    // Throws UsageError for a path that cannot be written, what the format cannot hold and a body
    // that cannot be read.
    Player(std::filesystem::path, const Scene&, double tap_rate);
    // Returns how loud it is. Throws Unwritable.
    std::string write(const Trace&) const;

private:
    std::filesystem::path path_;
    std::vector<std::vector<double>> body_;  // its response for each tap; none: no body
};

// ---- In parts.

struct Played {
    std::vector<std::vector<double>> channels;  // of full scale 1
    // what 1 stands for [N], with a body by its response; 0: silence
    double full_scale = 0;
    double peak = 0, rms = 0;  // of full scale, over all channels
    long clipped = 0;          // samples beyond it
};
std::vector<double> without_body(std::span<const double> force, double rate);
std::vector<double> without_steady(std::span<const double> force, double rate);
Played levelled(std::vector<std::vector<double>> channels);
// "full scale 1.2 N, peak -1.0 dB, rms -20.3 dB, 0 samples clipped"
std::string level_text(const Played&);
// throws Unwritable
void write_audio(const std::filesystem::path&, double rate,
                 const std::vector<std::vector<double>>& channels);

// ---- The body

// The impulse response in a .wav of one channel, at `rate` [Hz]. A file holds h[n] = h(n T) T, so
// that its sum is the response to a steady force at any rate. One of another rate is resampled by
// libsamplerate, and comes later by 64 rows of its own. Throws UsageError naming `key`.
std::vector<double> impulse_response(const std::string& file, double rate, const std::string& key);

// The body's response for each tap that it answers: the driving force, and the force on the nut, of
// all strings. Throws UsageError.
std::vector<std::vector<double>> body_responses(const Scene&, double rate);

}  // namespace jvari::bench::command
