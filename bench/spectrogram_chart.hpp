// Spectrograms side by side, 0-8 kHz, in decibels below their common maximum, as a Vega-Lite specification of rectangles.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace jvari {

// A spectrogram made coarse enough to be drawn: the strongest bin in each row of frequency, frame by frame.
struct Levels {
    int frames = 0, rows = 0;
    double start = 0, hop = 0;  // of the first frame's left edge, from frame to frame [s]
    double row_hz = 0;
    std::vector<int> level;  // frames x rows, tenths of a decibel re the unit squared; -4000 and below is silence
};
// At most 60 frames of 46 ms (Hann; shorter where the signal is) and 100 rows; none for fewer than 64 rows of signal.
Levels levels_of(std::span<const double> signal, double rate);

struct Panel {
    std::string across, down;  // names of its column and of its row
    std::string status;        // stands where there is no spectrogram: "refused"
    Levels levels;
};
// Panels on a grid, columns and rows in the order in which they first come up. At most `most` rectangles: equal neighbours in time are one,
// what lies 80 dB below the maximum is background, and the steps of level, time and frequency grow until they fit.
std::string spectrogram_spec(const std::string& title, const std::string& subtitle, std::vector<Panel>, int most = 14000);

}  // namespace jvari
