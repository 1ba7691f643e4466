// A run as a notebook shows it: for each column a picture, and for each tap a sound.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "bench/store/encoding.hpp"
#include "bench/store/trace_file.hpp"
#include "python/values.hpp"

namespace jvari::python {

// Path through the least and the largest value in each of `width` parts, within `height` pixels.
inline std::string envelope(std::span<const double> x, double least, double most, int width,
                            int height) {
    std::string path = "M";
    const auto y = [&](double v) {
        return bench::store::text_of(
            std::round(10 * height * (most > least ? (most - v) / (most - least) : 0.5)) / 10);
    };
    const std::size_t parts = std::min<std::size_t>(static_cast<std::size_t>(width), x.size());
    for (std::size_t k = 0; k < parts; ++k) {
        const auto part =
            x.subspan(k * x.size() / parts, (k + 1) * x.size() / parts - k * x.size() / parts);
        const auto [low, high] = std::minmax_element(part.begin(), part.end());
        const std::string at = std::to_string(k * static_cast<std::size_t>(width) / parts);
        path += " " + at + "," + y(*low) + " " + at + "," + y(*high);
    }
    return path;
}

// WAV of 16 bits in base64, without the mean and as loud as possible; "" for silence, and at a rate
// that browsers do not play.
inline std::string sound_of(std::span<const double> x, double rate) {
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    std::vector<double> centred(x.begin(), x.end());
    for (double& v : centred) v -= mean;
    const bench::store::Sound sound = bench::store::sound_of(centred, rate);
    return sound.samples.empty() || rate > 192000
               ? ""
               : bench::store::base64(bench::store::wav_of(sound));
}

inline std::string html_of(const TakenRun& r) {
    constexpr int width = 640, height = 96;
    const Trace& trace = r.run.trace;
    using bench::store::escaped;
    const auto number = [](double v) {
        return py::str("{:.4g}").attr("format")(v).cast<std::string>();
    };
    std::string html;
    if (r.run.status.outcome != Outcome::ok)
        html = "<p>" + std::string(name_of(r.run.status.outcome)) + " at step " +
               std::to_string(r.run.status.step) + "; the rows before it are shown.</p>";
    for (std::size_t k = 0; k < r.units.size(); ++k) {
        const int at = static_cast<int>(k);
        const bool is_tap = at < trace.taps();
        const std::span<const double> x =
            is_tap ? trace.column(at) : trace.energy_column(at - trace.taps());
        if (x.empty()) continue;
        const auto [least, most] = std::minmax_element(x.begin(), x.end());
        const auto& [name, unit] = r.units[k];
        html += "<figure><figcaption>" + escaped(name) + ": " + number(*least) + " to " +
                number(*most) + " " + escaped(unit) + ", " +
                number(static_cast<double>(x.size() - 1) / trace.tap_rate) +
                " s</figcaption><svg width=\"" + std::to_string(width) + "\" height=\"" +
                std::to_string(height) + "\"><path fill=\"none\" stroke=\"currentColor\" d=\"" +
                envelope(x, *least, *most, width, height) + "\"/></svg>";
        if (const std::string sound = is_tap ? sound_of(x, trace.tap_rate) : ""; !sound.empty())
            html += "<br><audio controls src=\"data:audio/wav;base64," + sound + "\"></audio>";
        html += "</figure>";
    }
    return html;
}

}  // namespace jvari::python
