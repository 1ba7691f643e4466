// Why no cell is as accurate as asked: one sentence, made of rows whose cause is known.
#include "bench/compare/diagnosis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/compare/record/cheapest.hpp"
#include "tests/says.hpp"

using namespace jvari;
using namespace jvari::bench;

namespace {
struct Sample {
    double rate, error, octaves = 5, floor = 1e-9, in_model = NAN, certificate = 1e-9,
                        error_10ms = NAN, horizon = 0.008;
    const char* status = "ok";
};
store::Table cells_of(const std::vector<Sample>& samples, const std::string& scheme = "a") {
    store::Table t{{"cell",
                    "scene",
                    "scheme",
                    "options",
                    "rate",
                    "modes",
                    "status",
                    "flags",
                    "error_l2_50ms",
                    "floor_error_l2_50ms",
                    "certificate_l2_50ms",
                    "error_in_model_l2_50ms",
                    "error_l2_10ms",
                    "certificate_l2_10ms",
                    "horizon_s",
                    "third_octave_db",
                    "cost_s_per_s",
                    "cost_lower",
                    "cost_upper",
                    "wall_seconds",
                    "deepest_penetration"},
                   {}};
    for (const Sample& s : samples) {
        const auto text = [](double x) { return store::text_of(x); };
        t.rows.push_back({"1",
                          "s",
                          scheme,
                          "",
                          text(s.rate),
                          "10",
                          s.status,
                          "",
                          text(s.error),
                          text(s.floor),
                          text(s.certificate),
                          text(s.in_model),
                          text(s.error_10ms),
                          "0",
                          text(s.horizon),
                          text(s.octaves),
                          text(s.rate * 1e-6),
                          text(s.rate * 1e-6),
                          text(s.rate * 1e-6),
                          text(s.rate * 1e-6 * 0.06),
                          "1e-7"});  // 60 ms
    }
    return t;
}
std::vector<Sample> falling(double order, double first) {
    std::vector<Sample> all;
    for (const double k : {1, 2, 4, 8})
        all.push_back({44100 * k, first * std::pow(k, -order) * (k == 2 ? 1.02 : 1)});
    return all;
}
std::string why(const std::vector<Sample>& samples, double most) {
    const store::Table t = cells_of(samples);
    return compare::why_none(t, store::all_rows(t), "error_l2_50ms", most);
}

TEST(Diagnosis, NamesTheClosestCellWithItsModesRateAndErrorInPerCent) {
    EXPECT_TRUE(says(why(falling(1, 0.4), 0.01), "Closest: a, 10 modes at 352.8 kHz, 5 % error."));
    std::vector<Sample> wrong{{44100, 0.9988}};  // decibels are never said of it
    EXPECT_TRUE(says(why(wrong, 0.01), "100 % error."));
}

TEST(Diagnosis, ExtrapolatesWhereErrorsFallByAPowerAndCallsItThat) {
    const std::string text = why(falling(1, 0.4), 0.01);  // 0.05 at 352.8 kHz: five times that
    EXPECT_TRUE(says(text, "would be enough, extrapolated and not run"));
    const auto at = text.find("): ");
    EXPECT_NEAR(std::stod(text.substr(at + 3)), 5 * 352.8, 0.1 * 5 * 352.8) << text;
}

TEST(Diagnosis, ExtrapolatesNotBeyond64TimesTheHighestRate) {
    EXPECT_TRUE(says(why(falling(1, 0.4), 0.05 / 60), "extrapolated"));  // 0.05 at the highest rate
    EXPECT_FALSE(says(why(falling(1, 0.4), 0.05 / 70), "extrapolated"));
}

TEST(Diagnosis, TooFewRatesNoConvergenceAndOutOfReachAreThreeSentences) {
    std::vector<Sample> two = falling(2, 0.4);
    two.resize(2);
    EXPECT_TRUE(says(why(two, 0.01), "Two rates are too few to extrapolate: run a third."));
    EXPECT_FALSE(says(why(two, 0.01), "reach"));
    std::vector<Sample> flat = falling(0, 0.16);
    EXPECT_TRUE(says(why(flat, 0.01),
                     "hardly falls with the rate (order 0.00), so a higher rate will not help"));
    const std::string slow = why(falling(0.3, 0.16), 0.01);
    EXPECT_TRUE(says(slow, "falls with the rate (order 0.3), but no rate within reach is enough"));
}

TEST(Diagnosis, OfThreeRatesWithAWideIntervalNothingIsSaidOfAHigherRate) {
    // order 0.95 +- 5
    store::Table t = cells_of({{44100, 0.0152}, {88200, 0.0049}, {176400, 0.0041}});
    const auto text = [&t] {
        return compare::why_none(t, store::all_rows(t), "error_l2_50ms", 0.001);
    };
    EXPECT_TRUE(says(text(), "From these rates it cannot be told whether a higher rate helps."))
        << text();
    EXPECT_FALSE(says(text(), "order")) << text();
    EXPECT_FALSE(says(text(), "--modes")) << text();
    t.columns.emplace_back("reference_modes");
    for (auto& row : t.rows) row.emplace_back("15");
    EXPECT_TRUE(says(text(), "helps. More modes may help: try `--modes 15`.")) << text();
    // the error is of the scheme
    for (auto& row : t.rows)
        row[static_cast<std::size_t>(t.column("error_in_model_l2_50ms"))] = "0.004";
    EXPECT_FALSE(says(text(), "--modes")) << text();
    store::Table falls = cells_of(falling(1, 0.4));
    falls.columns.emplace_back("reference_modes");
    for (auto& row : falls.rows) row.emplace_back("15");
    EXPECT_FALSE(
        says(compare::why_none(falls, store::all_rows(falls), "error_l2_50ms", 0.01), "--modes"));
}

TEST(Diagnosis, RatesThatWereRunOverTheHeadlinesWindowAloneCountForTheOrder) {
    std::vector<Sample> some = falling(1, 0.4);
    some[0].status = some[1].status = "not_needed";
    const store::Table t = cells_of(some);
    EXPECT_TRUE(says(compare::why_none(t, {2, 3}, "error_l2_50ms", 0.01), "would be enough"));
}

TEST(Diagnosis, AHorizonIsSaidOnlyWhereItLiesBeforeTheEnd) {
    std::vector<Sample> guitar = falling(0.15, 0.16);
    guitar[2].octaves = 0.9;
    const std::string text = why(guitar, 0.01);
    EXPECT_TRUE(says(text, "Its waveform is within 10 % for 8 ms."));
    EXPECT_TRUE(says(text, "By third octaves 1 dB is reached by a, 10 modes at 176.4 kHz."));
    for (Sample& s : guitar) s.horizon = 0.06;
    EXPECT_FALSE(says(why(guitar, 0.01), "Its waveform")) << why(guitar, 0.01);
    EXPECT_EQ(compare::time_text(0.1), "100 ms");
    EXPECT_EQ(compare::time_text(0.28), "280 ms");
    EXPECT_EQ(compare::time_text(1.24), "1.2 s");
}

TEST(Diagnosis, NamesNoiseReferenceAndModesWhereTheyStandInTheWay) {
    std::vector<Sample> noisy = falling(1, 0.4), unsure = noisy, truncated = falling(0.1, 0.03),
                        brief = falling(0.1, 0.3);
    for (Sample& s : noisy) s.floor = 0.02;
    for (Sample& s : unsure) s.certificate = 0.03;
    for (Sample& s : truncated) s.in_model = 1e-4;
    for (Sample& s : brief) s.error_10ms = 0.005;
    EXPECT_TRUE(says(why(noisy, 0.01), "A change of the start by 1e-12 alone makes 2 %."));
    EXPECT_FALSE(says(why(noisy, 0.01), "extrapolated"));
    EXPECT_TRUE(says(why(unsure, 0.01), "The reference is known to 3 % only."));
    EXPECT_TRUE(says(why(truncated, 0.01),
                     "Most of that comes from the modes left out: try `--modes 20`."));
    EXPECT_FALSE(says(why(truncated, 0.01), "order"));
    EXPECT_TRUE(
        says(why(brief, 0.01), "Over the first 10 ms a, 10 modes at 44.1 kHz is within 1 %."));
}

TEST(Diagnosis, SaysWhereMoreModesHelp) {
    store::Table t = cells_of({{44100, 0.2}, {44100, 0.1}});
    t.rows[0][5] = "5";
    const auto text = [&t] {
        return compare::why_none(t, store::all_rows(t), "error_l2_50ms", 0.01);
    };
    EXPECT_TRUE(says(text(), "The error falls with the modes: try `--modes 20`.")) << text();
    t.rows[0][8] = "0.11";  // order 0.14
    EXPECT_FALSE(says(text(), "--modes")) << text();
}

TEST(Diagnosis, SaysThatMatchedComplianceWasNotRun) {
    store::Table t = cells_of(falling(0.1, 0.3), "modal_two_point");
    EXPECT_TRUE(says(compare::why_none(t, store::all_rows(t), "error_l2_50ms", 0.01),
                     "compliance=matched was not run."));
    t.rows[1][3] = "compliance=matched";
    EXPECT_FALSE(
        says(compare::why_none(t, store::all_rows(t), "error_l2_50ms", 0.01), "was not run"));
}

TEST(Diagnosis, StandsInTheTableOfTheCheapestWhereItSaysNone) {
    const store::Table t = compare::cheapest_of(cells_of(falling(0.15, 0.16)));
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        EXPECT_EQ(!t.at(i, "why").empty(),
                  t.at(i, "status") == "none" && t.at(i, "measure") != "third_octave_db")
            << i;
    EXPECT_TRUE(says(compare::cheapest_text(t), "none. Closest: a, 10 modes at"))
        << compare::cheapest_text(t);
}
}  // namespace
