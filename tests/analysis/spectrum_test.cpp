// Spectra of signals whose spectra are known: tones, impulses, scaled and shifted copies.
#include "analysis/spectrum.hpp"
#include "schemes/trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>
#include <thread>

namespace jvari {
namespace {
using Signal = std::vector<double>;
using std::numbers::pi;
constexpr double cd_rate = 44100;
const BandChoice audible = {
    .lowest = 100, .highest = 20e3, .taper = Taper::rectangular, .range = 100};

Signal cosine(long rows, double hertz, double amplitude, double phase = 0.3) {
    Signal x(rows);
    for (long n = 0; n < rows; ++n)
        x[n] = amplitude * std::cos(2 * pi * hertz * n / cd_rate + phase);
    return x;
}
Signal noise(long rows, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Signal x(rows);
    for (double& v : x) v = normal(random);
    return x;
}
Signal times(Signal x, double factor) {
    for (double& v : x) v *= factor;
    return x;
}
Signal plus(Signal a, const Signal& b) {
    for (std::size_t n = 0; n < a.size(); ++n) a[n] += b[n];
    return a;
}
double total(const PowerSpectrum& s) {
    return std::accumulate(s.power.begin(), s.power.end(), 0.0);
}

TEST(PowerSpectrum, SumsToTheMeanSquareForOddAndEvenLengths) {
    for (long rows : {1, 2, 5, 4410, 44101}) {
        const Signal x = noise(rows, 3);
        double square = 0, windowed = 0, weight = 0;
        for (long n = 0; n < rows; ++n) {
            const double w = 0.5 - 0.5 * std::cos(2 * pi * n / rows);
            square += x[n] * x[n] / rows, windowed += w * w * x[n] * x[n], weight += w * w;
        }
        EXPECT_NEAR(total(power_spectrum(x, cd_rate, Taper::rectangular)), square, 1e-12 * square)
            << rows;
        if (rows == 1) continue;  // one row is under the end of its window
        EXPECT_NEAR(total(power_spectrum(x, cd_rate)), windowed / weight, 1e-12 * square) << rows;
    }
}

TEST(PowerSpectrum, AToneHoldsHalfItsAmplitudeSquaredOnAndBetweenBins) {
    const auto on = power_spectrum(cosine(4410, 1000, 3), cd_rate);
    EXPECT_NEAR(on.bin_hz, 10, 1e-12);
    EXPECT_NEAR(total(on), 4.5, 1e-12);
    EXPECT_NEAR(on.power[100], 4.5 * 2 / 3, 1e-12);  // Hann: 1/6, 2/3, 1/6 of the power
    EXPECT_NEAR(on.power[99], 4.5 / 6, 1e-12);
    EXPECT_NEAR(on.power[103], 0, 1e-25);
    EXPECT_NEAR(total(power_spectrum(cosine(4410, 1003.7, 3), cd_rate)), 4.5, 1e-6);
    // a constant has one side
    EXPECT_NEAR(power_spectrum(Signal(64, 2.0), cd_rate, Taper::rectangular).power[0], 4, 1e-14);
}

TEST(PowerSpectrum, DoesNotChangeWhenAPeriodicSignalIsShifted) {
    const Signal x = noise(1000, 5);
    Signal y = x;
    std::rotate(y.begin(), y.begin() + 137, y.end());
    const auto a = power_spectrum(x, cd_rate, Taper::rectangular),
               b = power_spectrum(y, cd_rate, Taper::rectangular);
    for (std::size_t k = 0; k < a.power.size(); ++k) EXPECT_NEAR(a.power[k], b.power[k], 1e-14);
    EXPECT_LT(third_octave_difference(y, x, cd_rate, audible), 1e-10);
}

TEST(ThirdOctaves, AToneIsInItsBandWithItsLevel) {
    for (double hertz : {100.0, 800.0, 1000.0, 5010.0, 15850.0}) {
        const auto b = third_octaves(cosine(44100, hertz, 0.2), cd_rate, audible);
        ASSERT_EQ(b.centre.size(), 24u);
        for (std::size_t i = 0; i < b.centre.size(); ++i) {
            const bool mine = hertz > b.centre[i] * std::pow(10, -0.05) &&
                              hertz < b.centre[i] * std::pow(10, 0.05);
            if (mine) {
                EXPECT_NEAR(b.level[i], 10 * std::log10(0.02), 1e-9) << hertz;
            } else {
                EXPECT_LT(b.level[i], -200) << hertz << " " << b.centre[i];
            }
        }
    }
    const auto b = third_octaves(cosine(44100, 440, 1), cd_rate, audible);
    EXPECT_NEAR(b.centre[0], 100, 1e-9);
    EXPECT_NEAR(b.centre[10], 1000, 1e-9);
    EXPECT_NEAR(b.centre[23], 19952.6, 0.1);
}

TEST(ThirdOctaves, AnImpulseRisesOneDecibelPerBandWhereverTheEdgesFallBetweenBins) {
    for (long rows : {44100, 44101, 5000}) {
        Signal x(rows, 0.0);
        x[rows / 3] = 1;
        const auto b = third_octaves(x, cd_rate, audible);
        // the last band is cut at half the rate
        for (std::size_t i = 0; i + 1 < b.centre.size(); ++i) {
            const double width = b.centre[i] * (std::pow(10, 0.05) - std::pow(10, -0.05));
            EXPECT_NEAR(b.level[i], 10 * std::log10(2 * width / (cd_rate * rows)), 1e-9)
                << rows << " " << b.centre[i];
        }
        EXPECT_NEAR(
            b.level.back(),
            10 * std::log10(2 * (22050 - 19952.623 * std::pow(10, -0.05)) / (cd_rate * rows)),
            2e-3);
    }
}

TEST(ThirdOctaves, BandsNarrowerThanABinAndAboveHalfTheRateAreLeftOut) {
    // bins of 100 Hz; the band at 501 Hz is 116 Hz audible, that at 398 Hz 92 Hz
    const auto b = third_octaves(noise(441, 2), cd_rate);
    EXPECT_NEAR(b.centre.front(), 501.19, 0.01);
    EXPECT_NEAR(third_octaves(noise(8000, 2), 8000).centre.back(), 3981.07, 0.01);
    // by nominal names
    EXPECT_NEAR(
        third_octaves(noise(44100, 2), cd_rate, {.lowest = 20, .highest = 16e3}).centre.front(),
        19.953, 1e-3);
    EXPECT_NEAR(
        third_octaves(noise(44100, 2), cd_rate, {.lowest = 20, .highest = 16e3}).centre.back(),
        15848.9, 0.1);
    EXPECT_NEAR(
        third_octaves(noise(44100, 2), cd_rate, {.lowest = 31.5, .highest = 12.5e3}).centre.front(),
        31.623, 1e-3);
    // as chosen where nothing is said: 50 Hz ... 16 kHz, Hann
    EXPECT_EQ(third_octaves(noise(44100, 2), cd_rate).centre.size(), 26u);
    EXPECT_NEAR(third_octaves(noise(44100, 2), cd_rate).centre.front(), 50.119, 1e-3);
    // 4 kHz, beside a tone between two bins
    EXPECT_LT(third_octaves(cosine(44100, 1000.5, 1), cd_rate).level[19], -150);
    EXPECT_GT(third_octaves(cosine(44100, 1000.5, 1), cd_rate, audible).level[16], -70);
    EXPECT_TRUE(third_octaves({}, cd_rate).centre.empty());
    EXPECT_TRUE(third_octaves(Signal{1}, cd_rate).centre.empty());
}

TEST(ThirdOctaves, AScaledCopyDiffersByItsGainForEitherTaper) {
    const Signal x = noise(10000, 8);
    for (double gain : {0.1, 0.9, 2.0}) {
        const double level = std::abs(20 * std::log10(gain));
        EXPECT_NEAR(third_octave_difference(times(x, gain), x, cd_rate), level, 1e-9);
        EXPECT_NEAR(third_octave_difference(times(x, -gain), x, cd_rate, audible), level, 1e-9);
    }
    EXPECT_EQ(third_octave_difference(x, x, cd_rate), 0);
}

TEST(ThirdOctaves, RootMeanSquareIsOverTheBandsWithEnergyAlone) {
    const Signal strong = cosine(44100, 1000, 1), weak = cosine(44100, 4000, 1e-3);
    const Signal r = plus(strong, weak), c = plus(times(strong, 2), times(weak, 0.5));
    // two bands, +6.02 and -6.02 dB
    EXPECT_NEAR(third_octave_difference(c, r, cd_rate), 20 * std::log10(2.0), 1e-6);
    EXPECT_NEAR(third_octave_difference(plus(times(strong, 2), weak), r, cd_rate),
                20 * std::log10(2.0) / std::sqrt(2.0), 1e-6);
    // the strong band alone
    EXPECT_NEAR(third_octave_difference(c, r, cd_rate, {.range = 50}), 20 * std::log10(2.0), 1e-6);
    // The band at 4 kHz is at -60 dB, the floor at -100 dB: a candidate without it is 40 dB off
    // there.
    EXPECT_NEAR(third_octave_difference(strong, r, cd_rate), 40 / std::sqrt(2.0), 1e-6);
}

TEST(Spectrogram, HasWholeFramesAndTheirInstants) {
    const auto s = spectrogram(noise(44100, 1), cd_rate, 1024, 256);
    EXPECT_EQ(s.frames, (44100 - 1024) / 256 + 1);
    EXPECT_EQ(s.bins, 513);
    EXPECT_DOUBLE_EQ(s.hop, 256 / cd_rate);
    EXPECT_DOUBLE_EQ(s.centre, 512 / cd_rate);
    EXPECT_EQ(s.power.size(), static_cast<std::size_t>(s.frames) * s.bins);
    EXPECT_EQ(spectrogram(noise(1024, 1), cd_rate, 1024, 256).frames, 1);
    EXPECT_EQ(spectrogram(noise(10, 1), cd_rate, 1024, 256).frames, 1);  // filled with zeros
    EXPECT_EQ(spectrogram({}, cd_rate, 1024, 256).frames, 0);
    EXPECT_THROW(spectrogram(noise(10, 1), cd_rate, 1, 1), std::invalid_argument);
    EXPECT_THROW(spectrogram(noise(10, 1), cd_rate, 16, 0), std::invalid_argument);
}

TEST(Spectrogram, EachFrameIsThePowerSpectrumOfItsRows) {
    const Signal x = noise(5000, 4);
    const auto s = spectrogram(x, cd_rate, 512, 100);
    for (int m : {0, 7, s.frames - 1}) {
        const auto p = power_spectrum(std::span(x).subspan(m * 100, 512), cd_rate);
        for (int k = 0; k < s.bins; ++k) EXPECT_NEAR(s.frame(m)[k], p.power[k], 1e-15);
    }
}

TEST(Stft, AScaledCopyDiffersByItsGainInLevelAndInNorm) {
    const Signal x = noise(20000, 6);
    for (double gain : {0.5, 1.1}) {
        for (const auto d : {multi_resolution_stft_difference(times(x, gain), x, cd_rate),
                             stft_difference(times(x, gain), x, cd_rate, 256)}) {
            EXPECT_NEAR(d.level, std::abs(20 * std::log10(gain)), 1e-9);
            EXPECT_NEAR(d.convergence, std::abs(gain - 1), 1e-12);
        }
    }
    // A copy that sinks below the floor is taken at the floor: a tone over a noise at -100 dB can
    // lose no more than what it had.
    const Signal faint = plus(cosine(20000, 440, 1), times(noise(20000, 6), 1e-4));
    EXPECT_NEAR(stft_difference(times(faint, 2), faint, cd_rate, 1024).level, 20 * std::log10(2.0),
                1e-9);
    EXPECT_LT(stft_difference(times(faint, 0.5), faint, cd_rate, 1024).level,
              20 * std::log10(2.0) - 0.1);
    const auto same = multi_resolution_stft_difference(x, x, cd_rate);
    EXPECT_EQ(same.level, 0);
    EXPECT_EQ(same.convergence, 0);
}

TEST(Stft, ForgivesPhaseButNotAWrongPitchOrAMissingOne) {
    const Signal x = cosine(20000, 440, 1);
    const auto phase = multi_resolution_stft_difference(cosine(20000, 440, 1, 1.9), x, cd_rate);
    const auto pitch = multi_resolution_stft_difference(cosine(20000, 466.16, 1), x, cd_rate);
    EXPECT_LT(phase.convergence, 2e-3);
    EXPECT_GT(pitch.convergence, 0.3);
    EXPECT_NEAR(multi_resolution_stft_difference(Signal(20000, 0.0), x, cd_rate).convergence, 1,
                1e-12);
}

TEST(Stft, LeavesOutWindowsLongerThanTheSignal) {
    const Signal x = noise(1500, 6), y = noise(1500, 7);
    const auto a = stft_difference(x, y, cd_rate, 512), b = stft_difference(x, y, cd_rate, 1024);
    EXPECT_NEAR(multi_resolution_stft_difference(x, y, cd_rate).level, (a.level + b.level) / 2,
                1e-12);
    EXPECT_GT(multi_resolution_stft_difference(Signal(100, 1.0), Signal(100, 2.0), cd_rate).level,
              6.0);
}

TEST(Differences, OfFailedCandidatesAreInfiniteAndOfEmptyReferencesNotANumber) {
    const Signal x = noise(5000, 9), zero(5000, 0.0), shorter = noise(4000, 9);
    Signal broken = x;
    broken[4321] = nan;
    const auto both = [](const Signal& c, const Signal& r) {
        return std::vector<double>{third_octave_difference(c, r, cd_rate),
                                   stft_difference(c, r, cd_rate, 512).level,
                                   multi_resolution_stft_difference(c, r, cd_rate).convergence};
    };
    for (const double d : both(broken, x)) EXPECT_EQ(d, inf);
    for (const double d : both(shorter, x)) EXPECT_EQ(d, inf);
    for (const double d : both({}, x)) EXPECT_EQ(d, inf);
    for (const double d : both(x, shorter)) EXPECT_NEAR(d, 0, 1e-12);
    for (const double d : both(x, zero)) EXPECT_TRUE(std::isnan(d));
    for (const double d : both(x, {})) EXPECT_TRUE(std::isnan(d));
    for (const double d : both(x, broken)) EXPECT_TRUE(std::isnan(d));
    // a silent candidate is at the floor
    EXPECT_TRUE(std::isfinite(third_octave_difference(zero, x, cd_rate)));
    EXPECT_TRUE(std::isnan(third_octave_difference(Signal{1}, Signal{1}, cd_rate)));
}

TEST(Centroid, IsThePowerWeightedMeanFrequencyOfEachFrame) {
    Signal x = plus(cosine(8192, 40 * cd_rate / 1024, 2), cosine(8192, 100 * cd_rate / 1024, 1));
    std::fill(x.begin() + 4096, x.end(), 0.0);
    const auto track = centroid_track(spectrogram(x, cd_rate, 1024, 1024));
    ASSERT_EQ(track.size(), 8u);
    EXPECT_NEAR(track[0], (4 * 40 + 100) / 5.0 * cd_rate / 1024, 1e-6);
    EXPECT_NEAR(track[3], track[0], 1e-6);
    EXPECT_TRUE(std::isnan(track[4]));
    EXPECT_TRUE(centroid_track({}).empty());
}

TEST(Spectra, ComeOutTheSameToTheBitAndFromSeveralThreadsAtOnce) {
    const Signal x = noise(1200, 1), y = noise(1200, 2);
    const auto all = [&] {  // many lengths: each plans anew
        Signal found;
        for (int rows = 1000; rows < 1200; ++rows)
            found.push_back(third_octave_difference(x, std::span(y).first(rows), cd_rate));
        return found;
    };
    const Signal alone = all();
    std::vector<Signal> found(4);
    std::vector<std::thread> threads;
    for (Signal& f : found) threads.emplace_back([&] { f = all(); });
    for (auto& t : threads) t.join();
    for (const Signal& f : found) EXPECT_EQ(f, alone);
}

}  // namespace
}  // namespace jvari
