// Why no cell is as accurate as asked: one sentence, made of rows whose cause is known.
#include "bench/compare/diagnosis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/compare/record/cheapest.hpp"

using namespace jvari::bench;

namespace {
struct Sample {
    double rate, error, octaves = 5, floor = 1e-9, in_model = NAN, certificate = 1e-9, error_10ms = NAN;
};
store::Table cells_of(const std::vector<Sample>& samples) {
    store::Table t{{"cell", "scene", "scheme", "options", "rate", "modes", "status", "flags", "error_l2_50ms", "floor_error_l2_50ms",
                    "certificate_l2_50ms", "error_in_model_l2_50ms", "error_l2_10ms", "horizon_s", "third_octave_db", "cost_s_per_s",
                    "cost_lower", "cost_upper"},
                   {}};
    for (const Sample& s : samples) {
        const auto text = [](double x) { return store::text_of(x); };
        t.rows.push_back({"1", "s", "a", "", text(s.rate), "10", "ok", "", text(s.error), text(s.floor), text(s.certificate),
                          text(s.in_model), text(s.error_10ms), "0.008", text(s.octaves), text(s.rate * 1e-6), text(s.rate * 1e-6),
                          text(s.rate * 1e-6)});
    }
    return t;
}
std::vector<Sample> falling(double order, double first) {
    std::vector<Sample> all;
    for (const double k : {1, 2, 4, 8}) all.push_back({44100 * k, first * std::pow(k, -order) * (k == 2 ? 1.02 : 1)});
    return all;
}
std::string why(const std::vector<Sample>& samples, double most) {
    const store::Table t = cells_of(samples);
    return compare::why_none(t, store::all_rows(t), "error_l2_50ms", most);
}
bool says(const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
}

TEST(Diagnosis, ExtrapolatesWhereErrorsFallByAPowerAndCallsItThat) {
    const std::string text = why(falling(1, 0.4), 0.01);  // 0.05 at 352.8 kHz: five times that
    EXPECT_TRUE(says(text, "extrapolated")) << text;
    const double at = text.find("so ");
    EXPECT_NEAR(std::stod(text.substr(static_cast<std::size_t>(at) + 3)), 5 * 352.8, 0.1 * 5 * 352.8) << text;
}

TEST(Diagnosis, ExtrapolatesFromThreeRatesAtLeastAndNotBeyond64TimesTheHighest) {
    std::vector<Sample> two = falling(1, 0.4), three = two;
    two.resize(2), three.resize(3);
    EXPECT_FALSE(says(why(two, 0.01), "extrapolated")) << why(two, 0.01);
    EXPECT_TRUE(says(why(three, 0.01), "extrapolated")) << why(three, 0.01);
    EXPECT_TRUE(says(why(falling(1, 0.4), 0.05 / 60), "extrapolated"));  // 0.05 at the highest rate
    EXPECT_FALSE(says(why(falling(1, 0.4), 0.05 / 70), "extrapolated"));
}

TEST(Diagnosis, SaysForHowLongWaveformsStayTogetherWhereNoRateWillDo) {
    std::vector<Sample> guitar = falling(0.15, 0.16);
    guitar[2].octaves = 0.9;
    const std::string text = why(guitar, 0.01);
    EXPECT_FALSE(says(text, "extrapolated")) << text;
    EXPECT_TRUE(says(text, "rate^-0.15 only")) << text;
    EXPECT_TRUE(says(text, "waveforms part after 8 ms")) << text;
    EXPECT_TRUE(says(text, "by third octaves 1 dB is reached by a at 176.4 kHz")) << text;
}

TEST(Diagnosis, NamesNoiseReferenceAndModesWhereTheyStandInTheWay) {
    std::vector<Sample> noisy = falling(1, 0.4), unsure = noisy, truncated = falling(0.1, 0.03), brief = falling(0.1, 0.3);
    for (Sample& s : noisy) s.floor = 0.02;
    for (Sample& s : unsure) s.certificate = 0.03;
    for (Sample& s : truncated) s.in_model = 1e-4;
    for (Sample& s : brief) s.error_10ms = 0.005;
    EXPECT_TRUE(says(why(noisy, 0.01), "a start 1e-12 apart alone makes 2 %"));
    EXPECT_FALSE(says(why(noisy, 0.01), "extrapolated"));
    EXPECT_TRUE(says(why(unsure, 0.01), "certain to 3 % only"));
    EXPECT_TRUE(says(why(truncated, 0.01), "0.01 % of it is the scheme's own"));
    EXPECT_TRUE(says(why(brief, 0.01), "over 10 ms a at 44.1 kHz is within"));
}

TEST(Diagnosis, StandsInTheTableOfTheCheapestWhereItSaysNone) {
    const store::Table t = compare::cheapest_of(cells_of(falling(0.15, 0.16)));
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        EXPECT_EQ(!t.at(i, "why").empty(), t.at(i, "status") == "none" && t.at(i, "measure") != "third_octave_db") << i;
    EXPECT_TRUE(says(compare::cheapest_text(t), "none\n    the nearest is a at")) << compare::cheapest_text(t);
}
}  // namespace
