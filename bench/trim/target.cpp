#include "bench/trim/target.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "analysis/error.hpp"
#include "analysis/spectrum.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::trim {

namespace {
using Signal = std::span<const double>;
constexpr double most_without_unit = 0.5;  // a larger tolerance is more likely meant in per cent

double l2_50ms(Signal c, Signal r, double rate) {
    constexpr double end = 50e-3;  // or the run's, where that is sooner
    return static_cast<double>(r.size()) > end * rate ? relative_l2(c, r, rate, {0, end}) : relative_l2(c, r, rate);
}

double stft_db(Signal c, Signal r, double rate) {
    return multi_resolution_stft_difference(c, r, rate).level;
}

double third_octave_db(Signal c, Signal r, double rate) {
    return third_octave_difference(c, r, rate);
}

// Root mean square difference of the centroid tracks over the mean centroid; frames within 60 dB of the truth's strongest.
double centroid(Signal c, Signal r, double rate) {
    constexpr int window = 1024, hop = 256;
    if (c.size() < r.size()) return HUGE_VAL;
    const Spectrogram of_c = spectrogram(c.first(r.size()), rate, window, hop), of_r = spectrogram(r, rate, window, hop);
    const std::vector<double> track_c = centroid_track(of_c), track_r = centroid_track(of_r);
    std::vector<double> power;
    for (int m = 0; m < of_r.frames; ++m) {
        double sum = 0;
        for (const double p : of_r.frame(m)) sum += p;
        power.push_back(sum);
    }
    const double strongest = power.empty() ? 0 : *std::max_element(power.begin(), power.end());
    double difference = 0, mean = 0;
    int frames = 0;
    for (int m = 0; m < of_r.frames; ++m) {
        if (!(power[m] > 1e-6 * strongest)) continue;
        if (!std::isfinite(track_c[m])) return HUGE_VAL;
        difference += (track_c[m] - track_r[m]) * (track_c[m] - track_r[m]);
        mean += track_r[m];
        ++frames;
    }
    return frames > 0 ? std::sqrt(difference / frames) / (mean / frames) : std::nan("");
}

// What is still to come of the energy, from each instant on (M. R. Schroeder 1965): the root mean square difference of the two curves [dB],
// over the first nine tenths of the run and down to 60 dB below the truth's start.
double decay(Signal c, Signal r, double) {
    if (c.size() < r.size()) return HUGE_VAL;
    const std::size_t last = r.size() * 9 / 10;
    double of_c = 0, of_r = 0, whole = 0, sum = 0;
    long rows = 0;
    for (const double x : r) whole += x * x;
    for (std::size_t n = r.size(); n-- > 0;) {
        of_c += c[n] * c[n];
        of_r += r[n] * r[n];
        if (n > last || !(of_r > 1e-6 * whole)) continue;
        const double db = 10 * std::log10(of_c / of_r);
        if (!std::isfinite(db)) return HUGE_VAL;
        sum += db * db;
        ++rows;
    }
    return rows > 0 ? std::sqrt(sum / static_cast<double>(rows)) : std::nan("");
}

constexpr Measure all[] = {{"l2_50ms", "relative L2 error, 0\u201350 ms", "%", l2_50ms, 50e-3},
                           {"third_octave_db", "third-octave difference", "dB", third_octave_db, HUGE_VAL},
                           {"stft", "multi-resolution STFT difference", "dB", stft_db, HUGE_VAL},
                           {"centroid", "centroid track, relative difference", "%", centroid, HUGE_VAL},
                           {"decay", "decay of the energy, difference", "dB", decay, HUGE_VAL}};
}  // namespace

std::span<const Measure> measures() {
    return all;
}

Target target_of(const std::string& name, const std::string& within) {
    const auto found = std::find_if(std::begin(all), std::end(all), [&](const Measure& m) { return name == m.name; });
    if (found == std::end(all)) {
        std::vector<std::string> names;
        for (const Measure& m : all) names.emplace_back(m.name);
        throw store::UsageError("--of " + store::unknown("measure", name, names));
    }
    double x = 0;
    const char* end = within.data() + within.size();
    const auto [stop, error] = std::from_chars(within.data(), end, x);
    std::string unit(stop, end);
    unit.erase(0, unit.find_first_not_of(' ') == std::string::npos ? unit.size() : unit.find_first_not_of(' '));
    const bool relative = std::string(found->unit) == "%";
    if (error != std::errc() || !std::isfinite(x) || !(x > 0) || (!unit.empty() && unit != found->unit))
        throw store::UsageError(
            fmt::format("--within {}: expected a tolerance of {}, as {}", within, found->name, relative ? "1%" : "1dB"));
    if (relative && unit.empty() && x > most_without_unit)
        throw store::UsageError(fmt::format("--within {}: without a unit this is {:.4g} %; say {}%, or {:.4g}% where that is meant", within,
                                            100 * x, within, 100 * x));
    return {&*found, unit == "%" ? x / 100 : x};
}

std::string text_of(const Measure& m, double error) {
    if (std::isnan(error)) return "-";
    return m.unit == std::string("%") ? fmt::format("{:.2g} %", 100 * error) : fmt::format("{:.2g} dB", error);
}

std::string certainty_text(const Measure& m, double certificate) {
    return std::isnan(certificate) ? "unknown" : text_of(m, certificate);
}

}  // namespace jvari::bench::trim
