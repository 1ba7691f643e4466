#include "bench/study/spectrogram_levels.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/spectrum.hpp"

namespace jvari::bench::study {

namespace {
constexpr double highest_hz = 8000;
}

Levels levels_of(std::span<const double> signal, double rate) {
    Levels l;
    const int size = static_cast<int>(signal.size());
    int window = 64;
    while (2 * window <= 0.047 * rate && 8 * window <= size) window *= 2;
    if (size < window) return l;
    const int hop = std::max(1, (size - window) / 59);
    const Spectrogram s = spectrogram(signal, rate, window, hop);
    const double highest = std::min(highest_hz, rate / 2);
    l.frames = s.frames;
    l.rows = std::max(1, std::min(100, static_cast<int>(highest / s.bin_hz)));
    l.row_hz = highest / l.rows;
    l.start = s.centre - s.hop / 2;
    l.hop = s.hop;
    l.level.assign(static_cast<std::size_t>(l.frames) * l.rows, silent_level);
    for (int m = 0; m < s.frames; ++m)
        for (int k = 0; k < s.bins && k * s.bin_hz < highest; ++k) {
            const int row = std::min(l.rows - 1, static_cast<int>(k * s.bin_hz / l.row_hz));
            const double power = s.frame(m)[k];
            int& level = l.level[static_cast<std::size_t>(m) * l.rows + row];
            if (power > 1e-40)
                level = std::max(level, static_cast<int>(std::lround(100 * std::log10(power))));
        }
    return l;
}

}  // namespace jvari::bench::study
