#include "bench/study/errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/error.hpp"
#include "analysis/spectrum.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::study {

class Pair {
public:
    Pair(std::span<const double> r, std::span<const double> of, double hz) : run(r), reference(of), rate(hz) {}
    const std::span<const double> run, reference;
    const double rate;
    const StftDifference& stft() {  // two measures are of it
        if (!stft_) stft_ = multi_resolution_stft_difference(run, reference, rate);
        return *stft_;
    }

private:
    std::optional<StftDifference> stft_;
};

const std::vector<Measure>& measures() {
    static const std::vector<Measure> all = {
        {"error_l2_10ms", "1", "relative L2 error, 0\u201310 ms", false, true, 10e-3,
         [](Pair& p) {
             return relative_l2(p.run, p.reference, p.rate, {0, 10e-3});
         }},
        {"error_l2_50ms", "1", "relative L2 error, 0\u201350 ms", false, true, 50e-3,
         [](Pair& p) {
             return relative_l2(p.run, p.reference, p.rate, {0, 50e-3});
         }},
        {"error_l2_whole", "1", "relative L2 error, whole run", false, true, HUGE_VAL,
         [](Pair& p) { return relative_l2(p.run, p.reference, p.rate); }},
        {"horizon_s", "s", "predictability horizon [s]", false, false, HUGE_VAL,
         [](Pair& p) { return horizon(p.run, p.reference, p.rate); }},
        {"third_octave_db", "dB", "third-octave difference [dB rms]", true, true, HUGE_VAL,
         [](Pair& p) { return third_octave_difference(p.run, p.reference, p.rate); }},
        {"stft_db", "dB", "multi-resolution STFT difference [dB]", false, true, HUGE_VAL, [](Pair& p) { return p.stft().level; }},
        {"stft_convergence", "1", "multi-resolution spectral convergence", false, true, HUGE_VAL,
         [](Pair& p) { return p.stft().convergence; }},
        {"centroid_hz", "Hz", "centroid track difference [Hz rms]", false, true, HUGE_VAL,
         [](Pair& p) { return centroid_difference(p.run, p.reference, p.rate); }},
    };
    return all;
}

std::size_t measure(const std::string& column) {
    return static_cast<std::size_t>(std::ranges::find(measures(), column, &Measure::column) - measures().begin());
}

Errors errors_of(const Trace& candidate, const Trace& reference, int taps, const Measures& only) {
    Errors errors;
    for (int k = 0; k < (taps < 0 ? reference.taps() : taps); ++k) {
        Pair pair(candidate.column(k), reference.column(k), reference.tap_rate);
        auto& of_tap = errors.emplace_back(measures().size(), store::nan);
        for (std::size_t m = 0; m < measures().size(); ++m)
            if (only.empty() || std::ranges::find(only, m) != only.end()) of_tap[m] = measures()[m].of(pair);
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

double headline_window(double duration) {
    return duration >= 50e-3 ? 50e-3 : duration >= 10e-3 ? 10e-3 : HUGE_VAL;
}

double horizon_of(const Errors& errors, const Headline& h) {
    return errors.empty() ? store::nan : errors[h.nut][measure("horizon_s")];
}

}  // namespace jvari::bench::study
