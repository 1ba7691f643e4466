#include "bench/study/errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "analysis/error.hpp"
#include "analysis/spectrum.hpp"
#include "bench/store/records.hpp"
#include "reference/agreement.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::study {

class Pair {
public:
    Pair(std::span<const double> r, std::span<const double> of, double hz)
        : run(r), reference(of), rate(hz) {}
    const std::span<const double> run, reference;
    const double rate;
    const StftDifference& stft() {  // shared by two measures
        if (!stft_) stft_ = multi_resolution_stft_difference(run, reference, rate);
        return *stft_;
    }

private:
    std::optional<StftDifference> stft_;
};

namespace {
constexpr double quietest = 1e-6;  // 60 dB below the reference's strongest frame, or its start

double over_50_ms(Pair& p) { return relative_l2(p.run, p.reference, p.rate, {0, 50e-3}); }

// Decay error [dB]: root mean square difference between two curves of the energy still to come (M.
// R. Schroeder 1965). The comparison covers the first nine tenths of the run, and ends earlier if
// the reference gets too quiet.
double decay(Pair& p) {
    const auto &c = p.run, &r = p.reference;
    if (c.size() < r.size()) return HUGE_VAL;
    const std::size_t last = r.size() * 9 / 10;
    double of_c = 0, of_r = 0, whole = 0, sum = 0;
    long rows = 0;
    for (const double x : r) whole += x * x;
    for (std::size_t n = r.size(); n-- > 0;) {
        of_c += c[n] * c[n];
        of_r += r[n] * r[n];
        if (n > last || !(of_r > quietest * whole)) continue;
        const double db = 10 * std::log10(of_c / of_r);
        if (!std::isfinite(db)) return HUGE_VAL;
        sum += db * db;
        ++rows;
    }
    return rows > 0 ? std::sqrt(sum / static_cast<double>(rows)) : nan;
}
}  // namespace

Scene heard_too(const Descriptor& d, const Scene& scene) {
    constexpr double highest_heard = 20e3;  // [Hz]
    const auto is_this = [name = std::string_view(d.name)](const Descriptor& other) {
        return name == other.name;
    };
    const bool built_in =
        std::ranges::any_of(schemes(), is_this) || std::ranges::any_of(references(), is_this);
    // only a scheme that moves in modes takes measured ones
    if (!built_in || !d.represents.has(Feature::measured_modes) ||
        std::ranges::all_of(scene.strings,
                            [](const String& s) { return modes_below(s, highest_heard) == 0; }))
        return scene;
    Scene twice = scene;
    for (Tap tap : scene.taps) {
        tap.name += " below 20 kHz", tap.below = highest_heard;
        twice.taps.push_back(std::move(tap));
    }
    return twice;
}

const char* name_of(Kind k) {
    return k == Kind::waveform ? "waveform" : k == Kind::bands ? "bands" : "other";
}

const std::vector<Measure>& measures() {
    static const std::vector<Measure> all = {
        {"error_l2_10ms", Kind::waveform, "1", "relative L2 error, 0\u201310 ms", "", false, true,
         10e-3,
         [](Pair& p) {
             return relative_l2(p.run, p.reference, p.rate, {0, 10e-3});
         }},
        {"error_l2_50ms", Kind::waveform, "1", "relative L2 error, 0\u201350 ms", "", false, true,
         50e-3, over_50_ms},
        {"error_l2_whole", Kind::waveform, "1", "relative L2 error, whole run", "", false, true,
         HUGE_VAL, [](Pair& p) { return relative_l2(p.run, p.reference, p.rate); }},
        {"error_l2_heard", Kind::waveform, "1",
         "heard: relative L2 error, 0\u201350 ms, modes below 20 kHz", "", false, true, 50e-3,
         over_50_ms, true},
        {"horizon_s", Kind::other, "s", "predictability horizon", "s", false, false, HUGE_VAL,
         [](Pair& p) { return horizon(p.run, p.reference, p.rate); }},
        {"third_octave_db", Kind::bands, "dB", "third-octave difference", "dB rms", true, true,
         HUGE_VAL, [](Pair& p) { return third_octave_difference(p.run, p.reference, p.rate); }},
        {"stft_db", Kind::bands, "dB", "multi-resolution STFT difference", "dB", false, true,
         HUGE_VAL, [](Pair& p) { return p.stft().level; }},
        {"stft_convergence", Kind::bands, "1", "multi-resolution spectral convergence", "", false,
         true, HUGE_VAL, [](Pair& p) { return p.stft().convergence; }},
        {"centroid_hz", Kind::other, "Hz", "centroid track difference", "Hz rms", false, true,
         HUGE_VAL,
         [](Pair& p) { return centroid_difference(p.run, p.reference, p.rate, 2048, 512).rms; }},
        {"centroid_relative", Kind::other, "1", "centroid track, relative difference", "", false,
         true, HUGE_VAL,
         [](Pair& p) {
             return centroid_difference(p.run, p.reference, p.rate, 1024, 256).relative();
         }},
        {"decay_db", Kind::other, "dB", "decay of the energy, difference", "dB", false, true,
         HUGE_VAL, decay},
    };
    return all;
}

std::size_t measure(const std::string& column) {
    return static_cast<std::size_t>(std::ranges::find(measures(), column, &Measure::column) -
                                    measures().begin());
}

std::span<const double> rows_for(std::size_t measure, const Trace& reference, int tap) {
    return measures()[measure].heard ? reference.heard(tap) : reference.column(tap);
}

double error_of(std::size_t measure, std::span<const double> run, std::span<const double> reference,
                double rate) {
    Pair pair(run, reference, rate);
    return measures()[measure].of(pair);
}

Errors errors_of(const Trace& candidate, const Trace& reference, const Measures& only,
                 double from) {
    Errors errors;
    for (int k = 0; k < reference.taps(); ++k) {
        auto& of_tap = errors.emplace_back(measures().size(), nan);
        const auto own =
            std::ranges::find(candidate.names, reference.names.at(k)) - candidate.names.begin();
        if (own == candidate.taps()) continue;
        const double rate = reference.tap_rate;
        const auto run = candidate.column(static_cast<int>(own)),
                   by_run = candidate.heard(static_cast<int>(own));
        Pair whole(rows_from(run, from, rate), rows_from(reference.column(k), from, rate), rate),
            heard(rows_from(by_run.empty() ? run : by_run, from, rate),
                  rows_from(reference.heard(k), from, rate), rate);
        for (std::size_t m = 0; m < measures().size(); ++m)
            if (only.empty() || std::ranges::find(only, m) != only.end())
                of_tap[m] = measures()[m].of(measures()[m].heard ? heard : whole);
    }
    return errors;
}

Headline headline_of(const Scene& scene) {
    const auto first = [&scene](Quantity q) {
        for (std::size_t k = 0; k < scene.taps.size(); ++k)
            if (scene.taps[k].quantity == q) return static_cast<int>(k);
        return -1;
    };
    Headline h;
    h.nut = std::max(0, first(Quantity::nut_force));
    h.bridge = first(Quantity::bridge_force);
    if (h.bridge < 0) h.bridge = first(Quantity::driving_force);
    if (h.bridge < 0) h.bridge = h.nut;
    return h;
}

double headline_window(const Scene& scene) {
    const double duration = scene.duration - free_from(scene);
    return duration >= 50e-3 ? 50e-3 : duration >= 10e-3 ? 10e-3 : HUGE_VAL;
}

std::size_t waveform_over(double window) {
    return static_cast<std::size_t>(std::ranges::find(measures(), window, &Measure::window) -
                                    measures().begin());
}

double horizon_of(const Errors& errors, const Headline& h) {
    return errors.empty() ? nan : errors[h.nut][measure("horizon_s")];
}

}  // namespace jvari::bench::study
