// Why no cell is as accurate as asked: one sentence, made of rows whose cause is known.
#include "bench/compare/scene_notes.hpp"

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
study::Cells cells_of(const std::vector<Sample>& samples, const std::string& scheme = "a") {
    study::Cells cells;
    for (const Sample& s : samples) {
        study::TabledCell& c = cells.emplace_back();
        c.scene = "s", c.scheme = scheme, c.status = s.status;
        c.rate = s.rate, c.modes = 10;
        c.cost_s_per_s = c.cost_lower = c.cost_upper = s.rate * 1e-6;
        c.wall_seconds = s.rate * 1e-6 * 0.06;  // 60 ms
        c.deepest_penetration = 1e-7;
        c.taps = {c.headline_nut = c.headline_bridge = "nut"};
        auto& figures = c.figures.emplace_back(study::measures().size());
        figures[study::measure("error_l2_50ms")] = {s.error, s.floor, s.certificate, s.in_model};
        figures[study::measure("error_l2_10ms")] = {s.error_10ms, NAN, 0};
        figures[study::measure("horizon_s")].value = s.horizon;
        figures[study::measure("third_octave_db")].value = s.octaves;
    }
    return cells;
}
study::Figure& headline(study::TabledCell& c) {
    return c.figures[0][study::measure("error_l2_50ms")];
}
std::string why(const study::Cells& cells, double most) {
    return compare::why_none(cells, study::all_rows(cells), study::measure("error_l2_50ms"), most);
}
std::vector<Sample> falling(double order, double first) {
    std::vector<Sample> all;
    for (const double k : {1, 2, 4, 8})
        all.push_back({44100 * k, first * std::pow(k, -order) * (k == 2 ? 1.02 : 1)});
    return all;
}
std::string why(const std::vector<Sample>& samples, double most) {
    return why(cells_of(samples), most);
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
    study::Cells cells = cells_of({{44100, 0.0152}, {88200, 0.0049}, {176400, 0.0041}});
    const auto text = [&cells] { return why(cells, 0.001); };
    EXPECT_TRUE(says(text(), "From these rates it cannot be told whether a higher rate helps."));
    EXPECT_FALSE(says(text(), "order")) << text();
    EXPECT_FALSE(says(text(), "--modes")) << text();
    for (study::TabledCell& c : cells) c.reference_modes = 15;
    EXPECT_TRUE(says(text(), "helps. More modes may help: try `--modes 15`."));
    // the error is of the scheme
    for (study::TabledCell& c : cells) headline(c).in_model = 0.004;
    EXPECT_FALSE(says(text(), "--modes")) << text();
    study::Cells falls = cells_of(falling(1, 0.4));
    for (study::TabledCell& c : falls) c.reference_modes = 15;
    EXPECT_FALSE(says(why(falls, 0.01), "--modes"));
}

TEST(Diagnosis, RatesThatWereRunOverTheHeadlinesWindowAloneCountForTheOrder) {
    std::vector<Sample> some = falling(1, 0.4);
    some[0].status = some[1].status = "not_needed";
    EXPECT_TRUE(
        says(compare::why_none(cells_of(some), {2, 3}, study::measure("error_l2_50ms"), 0.01),
             "would be enough"));
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
    study::Cells cells = cells_of({{44100, 0.2}, {44100, 0.1}});
    cells[0].modes = 5;
    EXPECT_TRUE(says(why(cells, 0.01), "The error falls with the modes: try `--modes 20`."));
    headline(cells[0]).value = 0.11;  // order 0.14
    EXPECT_FALSE(says(why(cells, 0.01), "--modes"));
}

TEST(Diagnosis, SaysThatMatchedComplianceWasNotRun) {
    study::Cells cells = cells_of(falling(0.1, 0.3), "modal_two_point");
    EXPECT_TRUE(says(why(cells, 0.01), "compliance=matched was not run."));
    cells[1].options = {{"compliance", "matched"}};
    EXPECT_FALSE(says(why(cells, 0.01), "was not run"));
}

TEST(Diagnosis, StandsInTheTableOfTheCheapestWhereItSaysNone) {
    const study::Cells cells = cells_of(falling(0.15, 0.16));
    const std::vector<compare::Answer> answers = compare::cheapest_of(cells);
    for (const compare::Answer& a : answers)
        EXPECT_EQ(!a.why.empty(), std::string(a.status) == "none" && study::is_waveform(a.measure))
            << a.goal();
    EXPECT_TRUE(says(store::text_of(compare::cheapest_lines(answers, cells)),
                     "none. Closest: a, 10 modes at"));
}
}  // namespace
