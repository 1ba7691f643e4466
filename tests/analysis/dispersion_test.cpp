// Frequencies and decay rates of sums of damped partials that were put together here.
#include "analysis/dispersion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace jvari {
namespace {

using Signal = std::vector<double>;
using std::numbers::pi;
constexpr double rate = 44100;

Signal sum_of(const std::vector<Partial>& partials, long rows) {
    Signal x(rows, 0.0);
    for (const Partial& p : partials)
        for (long n = 0; n < rows; ++n)
            x[n] += p.amplitude * std::exp(-p.decay * n / rate) *
                    std::cos(2 * pi * p.frequency * n / rate + p.phase);
    return x;
}

// Modes of the C3 string of van Walstijn et al. 2016, Table 1, with an unkind set of phases.
std::vector<Partial> c3(int first, int last) {
    std::vector<Partial> partials;
    for (int i = first; i <= last; ++i) {
        const double beta = i * pi;
        const double f = beta * std::sqrt((33.1 + 6.03e-5 * beta * beta) / 4.83e-4) / (2 * pi);
        partials.push_back(
            {f, 0.6 + 6.5e-3 * beta + 5.0e-6 * beta * beta * beta, 1.0 / i, 2.4 * i});
    }
    return partials;
}
double spacing(int i) { return c3(i + 1, i + 1)[0].frequency - c3(i, i)[0].frequency; }

TEST(Dispersion, TwentyPartialsInASecondAreFoundToAThousandthOfACentAndAThousandthOfTheirDecay) {
    const auto truth = c3(1, 20);
    const Signal x = sum_of(truth, 44100);
    double worst_cents = 0, worst_decay = 0;
    for (int i = 1; i <= 20; ++i) {
        const Partial& t = truth[i - 1];
        // the guess is 17 cents off
        const Partial p = strongest_near(x, rate, t.frequency * 1.01, 0.4 * spacing(i));
        worst_cents = std::max(worst_cents, std::abs(cents(p.frequency, t.frequency)));
        worst_decay = std::max(worst_decay, std::abs(p.decay / t.decay - 1));
        EXPECT_LT(std::abs(cents(p.frequency, t.frequency)), 1e-3) << i;
        EXPECT_NEAR(p.decay, t.decay, 1e-3 * t.decay) << i;
        EXPECT_NEAR(p.amplitude, t.amplitude, 1e-5 * t.amplitude) << i;
        EXPECT_NEAR(std::remainder(p.phase - t.phase, 2 * pi), 0, 1e-5) << i;
    }
    RecordProperty("worst_cents", std::to_string(worst_cents));
    std::printf("worst: %.1e cents, %.1e of the decay rate\n", worst_cents, worst_decay);
}

TEST(Dispersion, OneBandGivesAllItsPartials) {
    const auto truth = c3(1, 20);
    const auto found = partials_between(sum_of(truth, 44100), rate, 1000, 2000);  // modes 8 ... 15
    ASSERT_EQ(found.size(), 8u);
    for (int k = 0; k < 8; ++k) {
        EXPECT_LT(std::abs(cents(found[k].frequency, truth[7 + k].frequency)), 1e-3) << k;
        EXPECT_NEAR(found[k].decay, truth[7 + k].decay, 1e-3 * truth[7 + k].decay) << k;
    }
}

TEST(Dispersion, ModesBroaderThanTheirSpacingAreToldApartInAWideBand) {
    // near mode 120 the decay is 271/s (86 Hz broad), the spacing 160 Hz
    const auto truth = c3(1, 133);
    const Signal x = sum_of(truth, 44100);
    for (int i : {100, 120, 130}) {
        const Partial& t = truth[i - 1];
        const auto found = partials_between(x, rate, t.frequency - 500, t.frequency + 500);
        double nearest = std::numeric_limits<double>::infinity(), decay = 0;
        for (const Partial& p : found) {
            if (std::abs(cents(p.frequency, t.frequency)) > nearest) continue;
            nearest = std::abs(cents(p.frequency, t.frequency));
            decay = p.decay;
        }
        EXPECT_LT(nearest, 1e-3) << i;
        EXPECT_NEAR(decay, t.decay, 1e-3 * t.decay) << i;
    }
}

TEST(Dispersion, TellsApartPartialsHalfABinFromEachOther) {
    const std::vector<Partial> truth = {{440.0, 1.0, 1.0, 0.1}, {440.5, 1.5, 0.7, 2.0}};
    const auto found = partials_between(sum_of(truth, 44100), rate, 400, 480);
    ASSERT_EQ(found.size(), 2u);
    for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(found[k].frequency, truth[k].frequency, 1e-6);
        EXPECT_NEAR(found[k].decay, truth[k].decay, 1e-5);
        EXPECT_NEAR(found[k].amplitude, truth[k].amplitude, 1e-5);
    }
}

TEST(Dispersion, OfTwoPartialsTheOneThatStartsStrongerIsTheNearOne) {
    const Signal x = sum_of({{440.0, 30.0, 2.0, 0.1}, {450.0, 0.5, 1.0, 2.0}}, 44100);
    EXPECT_EQ(partials_between(x, rate, 415, 475).size(), 2u);
    EXPECT_NEAR(strongest_near(x, rate, 445, 30).frequency, 440, 1e-5);
}

TEST(Dispersion, UndampedAndGrowingPartialsKeepTheirSign) {
    EXPECT_NEAR(strongest_near(sum_of({{1000.3, 0, 1, 0}}, 44100), rate, 1000, 30).decay, 0, 1e-8);
    EXPECT_NEAR(strongest_near(sum_of({{1000.3, -2.5, 1, 0}}, 44100), rate, 1000, 30).decay, -2.5,
                1e-6);
}

TEST(Dispersion, ReachesFromNearZeroToNearHalfTheRate) {
    for (double f : {25.0, 21990.0}) {
        const Partial p = strongest_near(sum_of({{f, 1.2, 1, 0.7}}, 44100), rate, f + 2, 15);
        EXPECT_LT(std::abs(cents(p.frequency, f)), 1e-3) << f;
        EXPECT_NEAR(p.decay, 1.2, 1e-3) << f;
    }
}

TEST(Dispersion, NoiseMovesTheEstimateByNoMoreThanAFewTimesTheCramerRaoBound) {
    // One partial of amplitude a in white noise of deviation s: for T seconds undamped, var f = 6
    // s^2/(pi^2 a^2 T^3 rate) [Hz^2] and the decay's deviation is 2 pi times that of f.
    const double a = 1, s = 1e-2, deviation = std::sqrt(6 * s * s / (pi * pi * a * a * rate));
    std::mt19937 random(11);
    std::normal_distribution<double> normal(0, s);
    double frequency = 0, decay = 0;
    const int trials = 12;
    for (int k = 0; k < trials; ++k) {
        Signal x = sum_of({{440.0, 0.05, a, 0.5 * k}, {571.0, 2.0, 1.0, 0.2}}, 44100);
        for (double& v : x) v += normal(random);
        const Partial p = strongest_near(x, rate, 441, 50);
        frequency += (p.frequency - 440) * (p.frequency - 440) / trials;
        decay += (p.decay - 0.05) * (p.decay - 0.05) / trials;
    }
    std::printf("of the bound: frequency %.2f, decay %.2f\n", std::sqrt(frequency) / deviation,
                std::sqrt(decay) / (2 * pi * deviation));
    EXPECT_LT(std::sqrt(frequency), 2 * deviation);
    EXPECT_LT(std::sqrt(decay), 2 * 2 * pi * deviation);
}

TEST(Dispersion, HasNoPartialWhereThereIsNone) {
    EXPECT_TRUE(partials_between({}, rate, 100, 200).empty());
    EXPECT_TRUE(partials_between(Signal{1.0}, rate, 100, 200).empty());
    EXPECT_TRUE(partials_between(Signal(44100, 0.0), rate, 100, 200).empty());
    // 23 ms cannot resolve 10 Hz
    EXPECT_TRUE(partials_between(Signal(1000, 1.0), rate, 100, 110).empty());
    Signal x = sum_of({{440, 1, 1, 0}}, 44100);
    EXPECT_TRUE(partials_between(x, rate, 200, 100).empty());
    EXPECT_TRUE(partials_between(x, rate, 100, 100 + rate / 4).empty());  // it would meet its image
    EXPECT_EQ(partials_between(x, rate, 100, 100 + rate / 5.01).size(), 1u);
    EXPECT_TRUE(std::isnan(strongest_near(Signal(44100, 0.0), rate, 440, 50).frequency));
    EXPECT_TRUE(std::isnan(strongest_near(x, rate, 440, 0).frequency));
    x[5] = std::nan("");
    EXPECT_TRUE(partials_between(x, rate, 400, 480).empty());
}

TEST(Dispersion, CentsAreHundredthsOfASemitone) {
    EXPECT_DOUBLE_EQ(cents(880, 440), 1200);
    EXPECT_NEAR(cents(525, 523.2511), 5.776, 1e-3);  // C5 as 42 samples at 44.1 kHz
    EXPECT_LT(cents(439, 440), 0);
}

}  // namespace
}  // namespace jvari
