// Spectrograms side by side, 0-8 kHz, in decibels below their common maximum, as a Vega-Lite specification of rectangles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/study/spectrogram_levels.hpp"

namespace jvari::bench::report {

struct Panel {
    std::string across, down;  // names of its column and of its row
    std::string status;        // stands where there is no spectrogram: "refused"
    study::Levels levels;
    std::optional<study::Levels> against{};  // on the same grid: with it the signal `shown_field`, "level" or "difference", chooses
};
void add_once(std::vector<std::string>& names, const std::string& name);  // at the end

// Panels on a grid, columns and rows in the order in which they first come up. At most `most` rectangles: equal neighbours in time are one,
// what lies 80 dB below the maximum is background, and the steps of level, time and frequency grow until they fit.
std::string spectrogram_spec(const std::string& title, const std::string& subtitle, std::vector<Panel>, int most = 14000);

}  // namespace jvari::bench::report
