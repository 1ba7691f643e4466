#include "bench/study/errors.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "analysis/error.hpp"
#include "analysis/spectrum.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::study {

namespace {

std::vector<double> errors_of(std::span<const double> c, std::span<const double> r, double rate) {
    const StftDifference stft = multi_resolution_stft_difference(c, r, rate);
    return {relative_l2(c, r, rate, {0, 10e-3}),
            relative_l2(c, r, rate, {0, 50e-3}),
            relative_l2(c, r, rate),
            horizon(c, r, rate),
            third_octave_difference(c, r, rate),
            stft.level,
            stft.convergence,
            centroid_difference(c, r, rate)};
}
}  // namespace

const std::vector<Measure>& measures() {  // in the order of errors_of
    static const std::vector<Measure> all = {
        {"error_l2_10ms", "1", "relative L2 error, 0\u201310 ms", false, true, 10e-3},
        {"error_l2_50ms", "1", "relative L2 error, 0\u201350 ms", false, true, 50e-3},
        {"error_l2_whole", "1", "relative L2 error, whole run", false, true, HUGE_VAL},
        {"horizon_s", "s", "predictability horizon [s]", false, false, HUGE_VAL},
        {"third_octave_db", "dB", "third-octave difference [dB rms]", true, true, HUGE_VAL},
        {"stft_db", "dB", "multi-resolution STFT difference [dB]", false, true, HUGE_VAL},
        {"stft_convergence", "1", "multi-resolution spectral convergence", false, true, HUGE_VAL},
        {"centroid_hz", "Hz", "centroid track difference [Hz rms]", false, true, HUGE_VAL},
    };
    return all;
}

Errors errors_of(const Trace& candidate, const Trace& reference, int taps) {
    Errors errors;
    for (int k = 0; k < (taps < 0 ? reference.taps() : taps); ++k)
        errors.push_back(errors_of(candidate.column(k), reference.column(k), reference.tap_rate));
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
    std::size_t k = 0;
    while (measures()[k].column != "horizon_s") ++k;
    return errors.empty() ? store::nan : errors[h.nut][k];
}

}  // namespace jvari::bench::study
