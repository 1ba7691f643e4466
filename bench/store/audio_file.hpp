// What a player plays of a run, .wav or .flac: the force that the strings put on the body, 24 or 16 bit.
//
// The driving force of all strings where one has a barrier or a thread, else the force on the nut. The steady part is taken away (a high
// pass of first order at 20 Hz) and the highs are lowered as radio lowers them (a low pass of first order at 3183 Hz, the de-emphasis of
// 50 us): a force that is flat to 20 kHz is no sound that a body lets out. The largest sample then stands 1 dB below full scale.
// Left out: the body; dither. The signals as they are go to .csv and .h5.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::store {

constexpr double slowest_played = 3000, fastest_played = 384000;  // [Hz], a whole number: what players take

bool is_audio(const std::filesystem::path&);  // by its extension
Scene audible(Scene);                         // with the tap that is heard in place of its own

struct Played {
    std::vector<double> samples;  // of full scale 1
    double full_scale = 0;        // what 1 stands for, of the force as it is heard [N]; 0: silence
    double peak = 0, rms = 0;     // of full scale
    long clipped = 0;             // samples beyond it
};
Played played(std::span<const double> force, double rate);

std::string level_text(const Played&);  // "full scale 1.2 N, peak -1.0 dB, rms -20.3 dB, 0 samples clipped"

// `bits` 24 or 16. Throws std::runtime_error with the reason.
void write_audio(const std::filesystem::path&, const std::string& extension, int bits, double rate, const Played&);

}  // namespace jvari::bench::store
