// A spectrogram as it is kept beside a cell: coarse enough to be drawn.
#pragma once

#include <span>
#include <vector>

namespace jvari::bench::study {

// A spectrogram made coarse enough to be drawn: the strongest bin in each row of frequency, frame
// by frame.
struct Levels {
    int frames = 0, rows = 0;
    double start = 0, hop = 0;  // of the first frame's left edge, from frame to frame [s]
    double row_hz = 0;
    // frames x rows, tenths of a decibel re the unit squared; -4000 and below is silence
    std::vector<int> level;
};
constexpr int silent_level = -4000;  // [0.1 dB]

// At most 60 frames of 46 ms (Hann; shorter where the signal is) and 100 rows; none for fewer than
// 64 rows of signal.
Levels levels_of(std::span<const double> signal, double rate);

}  // namespace jvari::bench::study
