// Source: spectrum.hpp.
#include "analysis/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "analysis/squared_transform.hpp"
#include "schemes/trace.hpp"

namespace jvari {

namespace {
// |X|^2 for real frames with n rows, scaled to one-sided mean squares.
class Transform {
public:
    Transform(int n, Taper taper) : n_(n), window_(n, 1.0), transform_(n) {
        if (taper == Taper::hann)
            for (int i = 0; i < n; ++i)
                window_[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * i / n);
        for (double w : window_) weight_ += w * w;
    }

    int bins() const { return n_ / 2 + 1; }
    void operator()(std::span<const double> x, double* power) {  // rows past the end of x are zero
        for (int i = 0; i < n_; ++i)
            transform_.rows()[i] = i < static_cast<int>(x.size()) ? window_[i] * x[i] : 0.0;
        transform_.write(power);
        for (int k = 0; k < bins(); ++k) {
            const double sides = k == 0 || 2 * k == n_ ? 1 : 2;
            // Parseval: the sum is sum (x w)^2/sum w^2
            power[k] = weight_ > 0 ? sides * power[k] / (n_ * weight_) : 0.0;
        }
    }

private:
    int n_;
    std::vector<double> window_;
    double weight_ = 0;
    SquaredTransform transform_;
};

double decibel(double power) { return 10 * std::log10(power); }

// 0: compare; otherwise the result determined by the signals themselves (see the top of
// spectrum.hpp).
double verdict(std::span<const double>& candidate, std::span<const double> reference) {
    const auto finite = [](double v) { return std::isfinite(v); };
    if (!std::all_of(reference.begin(), reference.end(), finite)) return nan;
    // also for an empty reference
    if (std::all_of(reference.begin(), reference.end(), [](double v) { return v == 0; }))
        return nan;
    if (candidate.size() < reference.size()) return inf;
    candidate = candidate.first(reference.size());
    return std::all_of(candidate.begin(), candidate.end(), finite) ? 0 : inf;
}
}  // namespace

double power_between(const PowerSpectrum& spectrum, double from, double to) {
    const int bins = static_cast<int>(spectrum.power.size());
    double sum = 0;
    for (int k = std::max(0, static_cast<int>(from / spectrum.bin_hz)); k < bins; ++k) {
        const double left = std::max(k - 0.5, 0.0) * spectrum.bin_hz,
                     right = std::min(k + 0.5, bins - 1.0) * spectrum.bin_hz;
        if (left >= to) break;
        const double inside = std::min(right, to) - std::max(left, from);
        if (inside > 0) sum += spectrum.power[k] * inside / (right - left);
    }
    return sum;
}

PowerSpectrum power_spectrum(std::span<const double> signal, double rate, Taper taper) {
    if (signal.empty()) return {};
    Transform transform(static_cast<int>(signal.size()), taper);
    PowerSpectrum spectrum{rate / signal.size(), std::vector<double>(transform.bins())};
    transform(signal, spectrum.power.data());
    return spectrum;
}

Spectrogram spectrogram(std::span<const double> signal, double rate, int window, int hop) {
    if (window < 2 || hop < 1)
        throw std::invalid_argument(
            "a spectrogram needs a window of two rows or more and a hop of one or more");
    Spectrogram s;
    if (signal.empty()) return s;
    Transform transform(window, Taper::hann);
    const long rows = static_cast<long>(signal.size());
    s.frames = rows < window ? 1 : static_cast<int>((rows - window) / hop) + 1;
    s.bins = transform.bins();
    s.bin_hz = rate / window;
    s.hop = hop / rate;
    s.centre = 0.5 * window / rate;
    s.power.resize(static_cast<std::size_t>(s.frames) * s.bins);
    for (int m = 0; m < s.frames; ++m) {
        const long start = static_cast<long>(m) * hop;
        transform(signal.subspan(start, std::min<long>(window, rows - start)),
                  s.power.data() + static_cast<long>(m) * s.bins);
    }
    return s;
}

Bands third_octaves(std::span<const double> signal, double rate, const BandChoice& choice) {
    const PowerSpectrum spectrum = power_spectrum(signal, rate, choice.taper);
    const double flank = std::pow(10.0, 0.05);
    Bands bands;
    const auto number = [](double hertz) { return 10 * std::log10(hertz / 1000); };
    for (int n = static_cast<int>(std::ceil(number(choice.lowest / 1.02)));
         n <= number(choice.highest * 1.02); ++n) {
        const double centre = 1000 * std::pow(10.0, 0.1 * n);
        if (spectrum.power.empty() || centre >= 0.5 * rate ||
            centre * (flank - 1 / flank) < spectrum.bin_hz)
            continue;
        bands.centre.push_back(centre);
        bands.level.push_back(decibel(power_between(spectrum, centre / flank, centre * flank)));
    }
    return bands;
}

double third_octave_difference(std::span<const double> candidate, std::span<const double> reference,
                               double rate, const BandChoice& choice) {
    if (const double v = verdict(candidate, reference); v != 0) return v;
    const Bands c = third_octaves(candidate, rate, choice),
                r = third_octaves(reference, rate, choice);
    if (r.level.empty()) return nan;  // too short for any band
    const double floor = *std::max_element(r.level.begin(), r.level.end()) - choice.range;
    double squares = 0;
    int bands = 0;
    for (std::size_t i = 0; i < r.level.size(); ++i) {
        if (!(r.level[i] > floor)) continue;
        const double d = std::max(c.level[i], floor) - r.level[i];
        squares += d * d;
        ++bands;
    }
    // none: the whole reference energy is outside the bands
    return bands > 0 ? std::sqrt(squares / bands) : nan;
}

StftDifference stft_difference(std::span<const double> candidate, std::span<const double> reference,
                               double rate, int window, double range) {
    if (const double v = verdict(candidate, reference); v != 0) return {v, v};
    const int hop = std::max(1, window / 4);
    const Spectrogram c = spectrogram(candidate, rate, window, hop),
                      r = spectrogram(reference, rate, window, hop);
    const double strongest = *std::max_element(r.power.begin(), r.power.end());
    if (!(strongest > 0)) return {nan, nan};  // only rows under the ends of the window
    const double floor = strongest * std::pow(10.0, -0.1 * range);
    double level = 0, gap = 0, norm = 0;
    long cells = 0;
    for (std::size_t i = 0; i < r.power.size(); ++i) {
        const double d = std::sqrt(c.power[i]) - std::sqrt(r.power[i]);
        gap += d * d;
        norm += r.power[i];
        if (r.power[i] <= floor) continue;
        level += std::abs(decibel(std::max(c.power[i], floor) / r.power[i]));
        ++cells;
    }
    return {level / cells, std::sqrt(gap / norm)};
}

StftDifference multi_resolution_stft_difference(std::span<const double> candidate,
                                                std::span<const double> reference, double rate) {
    StftDifference mean{0, 0};
    int resolutions = 0;
    for (int window : {512, 1024, 2048, 4096}) {
        if (resolutions > 0 && window > static_cast<long>(reference.size())) break;
        const StftDifference d = stft_difference(candidate, reference, rate, window);
        mean.level += d.level;
        mean.convergence += d.convergence;
        ++resolutions;
    }
    return {mean.level / resolutions, mean.convergence / resolutions};
}

std::vector<double> centroid_track(const Spectrogram& s) {
    std::vector<double> track(s.frames);
    for (int m = 0; m < s.frames; ++m) {
        const auto power = s.frame(m);
        double moment = 0;
        for (int k = 0; k < s.bins; ++k) moment += k * s.bin_hz * power[k];
        const double total = std::accumulate(power.begin(), power.end(), 0.0);
        track[m] = total > 0 ? moment / total : nan;
    }
    return track;
}

CentroidDifference centroid_difference(std::span<const double> candidate,
                                       std::span<const double> reference, double rate, int window,
                                       int hop) {
    if (candidate.size() < reference.size()) return {inf, 1};
    const Spectrogram c = spectrogram(candidate.first(reference.size()), rate, window, hop),
                      r = spectrogram(reference, rate, window, hop);
    const auto of_c = centroid_track(c), of_r = centroid_track(r);
    const auto power_of = [](std::span<const double> bins) {
        return std::accumulate(bins.begin(), bins.end(), 0.0);
    };
    double strongest = 0, squares = 0, sum = 0;
    int frames = 0;
    for (int m = 0; m < r.frames; ++m) strongest = std::max(strongest, power_of(r.frame(m)));
    for (int m = 0; m < r.frames; ++m) {
        if (!(power_of(r.frame(m)) > 1e-6 * strongest)) continue;
        if (!std::isfinite(of_c[m])) return {inf, 1};
        squares += (of_c[m] - of_r[m]) * (of_c[m] - of_r[m]);
        sum += of_r[m];
        ++frames;
    }
    if (frames == 0) return {nan, nan};
    return {std::sqrt(squares / frames), sum / frames};
}

}  // namespace jvari
