// What a comparison says of its cells: what is known of an error, which are the cheapest and on the
// front, each column under its own name, and that all carry the same modes.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "bench/compare/bound.hpp"
#include "bench/compare/compare.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/study/cell.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/judgement.hpp"
#include "bench/study/truth.hpp"
#include "reference/agreement.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"
#include "tests/cells_from.hpp"
#include "tests/says.hpp"

namespace jvari {
namespace {
// ---- What is known of an error

TEST(Bound, IsErrorAndCertificateTogetherAsFarAsTheyTell) {
    struct {
        double error, certificate, least, most, shown;
        const char* text;
    } const rows[] = {{0.03, 0.02, 0.01, 0.05, 0.05, "\u22645.00e-02"},
                      {0.01, 0.02, 0, 0.03, 0.03, "\u22643.00e-02"},
                      // up to a tenth of the error the measured value stands
                      {0.03, 0.003, 0.027, 0.033, 0.03, "3.00e-02"},
                      {0.03, 0.0031, 0.0269, 0.0331, 0.0331, "\u22643.31e-02"},
                      {0.01, 0.98, 0, 0.99, 0.99, "\u22649.90e-01"},
                      {0.01, 0.99, 0, 1, 1, "not known"},
                      {1.3, 0.01, 1.29, 1.31, 1.3, "1.30e+00"},  // known to be all wrong
                      {0.03, nan, 0, nan, 0.03, "3.00e-02?"},
                      // a run that failed is known to
                      {HUGE_VAL, 0.1, HUGE_VAL, HUGE_VAL, HUGE_VAL, "inf"},
                      {HUGE_VAL, nan, HUGE_VAL, nan, HUGE_VAL, "inf"},
                      {nan, nan, 0, nan, nan, "-"}};
    for (const auto& row : rows) {
        const bench::compare::Bound b{row.error, row.certificate, nan};
        EXPECT_EQ(error_text(b, "{:.2e}"), row.text);
        for (const auto& [is, expected] :
             {std::pair{b.least(), row.least}, {b.most(), row.most}, {b.shown(), row.shown}})
            if (std::isnan(expected)) EXPECT_TRUE(std::isnan(is)) << row.text;
            else EXPECT_DOUBLE_EQ(is, expected) << row.text;
    }
}

TEST(Bound, OfAColumnHasTheCertificateAndTheFloorOfItsWindowAndTap) {
    const bench::study::Cells cells =
        test::cells_from({{"error_l2_50ms", "error_l2_50ms_nut", "error_l2_10ms", "third_octave_db",
                           "certificate_l2_50ms", "certificate_l2_50ms_nut", "certificate_l2_10ms",
                           "floor_error_l2_50ms", "floor_error_l2_50ms_nut"},
                          {{"1", "2", "3", "4", "5", "6", "7", "8", "9"}}});
    const auto of = [&](const char* measure, const char* tap = "") {
        return bench::compare::bound_of(cells[0], bench::study::measure(measure), tap);
    };
    const bench::compare::Bound window = of("error_l2_50ms"), tap = of("error_l2_50ms", "nut"),
                                octaves = of("third_octave_db");
    EXPECT_EQ(window.error, 1);
    EXPECT_EQ(window.certificate, 5);
    EXPECT_EQ(window.floor, 8);
    EXPECT_EQ(tap.error, 2);
    EXPECT_EQ(tap.certificate, 6);
    EXPECT_EQ(tap.floor, 9);
    EXPECT_EQ(of("error_l2_10ms").certificate, 7);
    EXPECT_EQ(octaves.error, 4);
    EXPECT_EQ(octaves.certificate, 0);  // spectral measures count as measured
}

TEST(Bound, TheHeadlineIsTheFirstWindowThatAnyOfTheRowsHas) {
    const bench::study::Cells cells = test::cells_from(
        {{"error_l2_10ms", "error_l2_50ms", "error_l2_whole"},
         {{"0.1", "", "0.2"}, {"0.1", "inf", "inf"}, {"", "", "0.3"}, {"1", "2", "3"}}});
    const auto of = [&](const bench::study::Rows& rows) {
        return bench::study::measures()[bench::compare::headline_error(cells, rows)].column;
    };
    EXPECT_EQ(of({0, 1, 2, 3}), "error_l2_50ms");
    EXPECT_EQ(of({0, 1, 2}), "error_l2_10ms");
    EXPECT_EQ(of({2}), "error_l2_whole");
    EXPECT_EQ(of({}), "error_l2_whole");
}

TEST(Bound, StandsBesideTheErrorInJson) {
    const nlohmann::ordered_json cell = bench::compare::json_of(
        test::cells_from({{"error_l2_10ms", "certificate_l2_10ms", "error_l2_50ms",
                           "error_l2_whole", "certificate_l2_whole"},
                          {{"0.25", "0.125", "0.25", "0.25", "0.75"}}}))[0];
    EXPECT_EQ(cell["bound_l2_10ms"], 0.375);
    EXPECT_TRUE(std::isnan(cell["bound_l2_50ms"].get<double>()));   // no certificate
    EXPECT_TRUE(std::isnan(cell["bound_l2_whole"].get<double>()));  // not known
    EXPECT_EQ(cell["errors"]["headline"]["error_l2_10ms"]["certificate"], 0.125);
}

// A tap may be called 7: the type of a column does not depend on the text in it.
TEST(Json, HasTextsWhereAColumnIsOfTextAndNumbersWhereItIsOfNumbers) {
    bench::study::TabledCell c;
    c.cell = "123", c.rate = 44100, c.pareto = false;
    c.taps = {"7"}, c.headline_nut = c.headline_bridge = "7";
    c.figures.emplace_back(bench::study::measures().size());
    c.swept = {{"string.0.tension", "30"}, {"string.0.start", "\"8\""}};
    const nlohmann::ordered_json cell = bench::compare::json_of({c})[0];
    EXPECT_EQ(cell["headline_nut"], "7");
    EXPECT_TRUE(cell["errors"].contains(cell["headline_nut"].get<std::string>()));
    EXPECT_EQ(cell["cell"], "123");
    EXPECT_EQ(cell["rate"], 44100);
    EXPECT_EQ(cell["pareto"], false);
    EXPECT_EQ(cell["string.0.tension"], 30);
    EXPECT_EQ(cell["string.0.start"], "\"8\"");
    EXPECT_TRUE(cell["modes"].is_null());
    for (const char* text : {"reason", "cause", "untimed", "reference"})
        EXPECT_EQ(cell[text], "") << text;
}

// ---- The cheapest and the front

struct Sample {  // a cell of the tables below
    std::string scheme, rate, flags, error, certificate, octaves;
    double cost;
    std::string status = "ok";
    bench::store::Options options = {};
    double lower = 0.95;  // quartile of the cost, as a part of it
    std::string certificate_10ms = "";
};
bench::study::Cells cells_of(const std::vector<Sample>& samples) {
    bench::store::Table t{
        {"cell", "scene", "scheme", "options", "rate", "modes", "status", "flags", "error_l2_50ms",
         "error_l2_10ms_nut", "certificate_l2_50ms", "certificate_l2_10ms",
         "certificate_l2_10ms_nut", "third_octave_db", "cost_s_per_s", "cost_lower", "cost_upper"},
        {}};
    for (const Sample& s : samples)
        t.rows.push_back({"1", "s", s.scheme, bench::store::options_text(s.options), s.rate, "10",
                          s.status, s.flags, s.error, s.error, s.certificate, s.certificate_10ms,
                          s.certificate, s.octaves, s.cost, s.lower * s.cost, 1.05 * s.cost});
    return test::cells_from(t);
}

enum Goal { within_10, within_1, within_01, within_3_db };  // rows of the table of the cheapest
struct Cheapest {
    const char* name;
    std::vector<Sample> cells;
    struct Answer {
        Goal goal;
        const char *column, *expected;
    };
    std::vector<Answer> answers;
    std::vector<const char*> lines = {};  // parts of the text
    bench::compare::Controls controls = bench::compare::Controls::stand_beside;
};
const std::vector<Sample> with_controls{
    {"modal_two_point_trapezoidal", "1", "", "5e-4", "0", "", 1},
    {"modal_two_point", "1", "", "0.005", "0", "", 2},
    {"modal_explicit_penalty", "1", "", "0.005", "0", "", 2}};
const Cheapest cheapest[] = {
    {"IsTheLeastCostAmongTheTrustedCellsThatAreAccurateEnough",
     {{"a", "100", "", "0.2", "0", "0.5", 1},
      {"a", "200", "", "0.009", "0", "0.5", 3},
      {"b", "100", "", "0.05", "0", "4", 2},
      {"c", "100", "adhesion", "0.0001", "0", "0.1", 0.5},  // pulls
      {"d", "100", "", "inf", "0", "inf", 0.1, "diverged"},
      {"e", "100", "", "0.04", "0", "4", 2.1}},  // touches b
     // that a more accurate one costs as much for all that is known changes nothing
     {{within_10, "run", "b, 10 modes at 0.1 kHz"},
      {within_10, "scheme", "b"},
      {within_10, "ties", "e, 10 modes at 0.1 kHz"},
      {within_1, "scheme", "a"},
      {within_1, "rate", "200"},
      {within_1, "ties", ""},
      {within_01, "scheme", ""},
      {within_01, "status", "none"},
      {within_3_db, "scheme", "a"},
      {within_3_db, "rate", "100"}},
     {"within 0.1 %   none. Closest: a, 10 modes"}},
    {"NamesWhatABusyClockCannotTellFromItAndNoneThatCosts1_2TimesTheLeast",
     {{"a", "44100", "", "0.009", "0", "", 1, "ok", {}, 0.5},
      {"a", "88200", "", "0.004", "0", "", 1.09, "ok", {}, 0.45},
      {"a", "176400", "", "0.001", "0", "", 1.3, "ok", {}, 0.38}},
     {{within_1, "rate", "44100"}, {within_1, "ties", "a, 10 modes at 88.2 kHz"}},
     {"a tie with a, 10 modes at 88.2 kHz"}},
    {"NamesEachTieWithItsOwnRateWhereOneHasNone",
     {{"a", "44100", "", "0.05", "0", "", 1},
      {"exact", "", "", "0.05", "0", "", 1.01},
      {"b", "88200", "", "0.05", "0", "", 1.02}},
     {{within_10, "ties", "exact, 10 modes; b, 10 modes at 88.2 kHz"}}},
    {"CannotBeDecidedWhereTheUncertaintyOfTheReferenceIsUnknown",
     {{"a", "44100", "", "0.052", "", "2", 1},
      {"b", "44100", "", "0.04", "", "2", 2},
      {"c", "44100", "", "inf", "", "", 0.1}},
     {{within_10, "status", "not_known"},
      {within_10, "scheme", ""},
      {within_10, "why",
       "the uncertainty of the reference is unknown; measured against it, the cheapest is a, 10 "
       "modes at 44.1 kHz, 5.2 %"},
      {within_1, "why", "the uncertainty of the reference is unknown"},
      {within_3_db, "scheme", "a"},  // as measured
      {within_3_db, "why", "measured against a reference whose uncertainty is unknown"}}},
    {"SaysWhatTheBestWithoutMatchedComplianceCosts",
     {{"a", "44100", "", "0.009", "0", "", 1, "ok", {{"compliance", "matched"}}},
      {"a", "88200", "", "0.0095", "0", "", 3, "ok", {{"compliance", "own"}}},
      {"b", "88200", "", "0.0094", "0", "", 2.5},
      {"b", "44100", "", "0.09", "0", "", 0.5}},
     {{within_1, "run", "a compliance=matched, 10 modes at 44.1 kHz"},
      {within_1, "as_published", "b, 10 modes at 88.2 kHz, 0.94 %, 2.5 s per s"},
      {within_10, "as_published", ""}}},  // b is as published
    {"ReachesATargetWithErrorAndCertificateTogether",
     {{"a", "100", "", "0.0095", "0.001", "", 1},  // 0.0085 to 0.0105
      {"b", "100", "", "0.0088", "0.001", "", 2},  // to 0.0098
      {"c", "100", "", "0.05", "0.001", "", 0.1},
      {"d", "100", "", "0.0005", "0.001", "", 9}},
     {{within_1, "scheme", "b"},
      {within_1, "error", "0.0088"},
      {within_1, "bound", "0.0098"},
      {within_1, "perhaps", "a, 10 modes at 0.1 kHz"},
      {within_01, "status", "not_known"},  // d is within 0.15 %
      {within_01, "scheme", ""},
      {within_01, "perhaps", "d, 10 modes at 0.1 kHz"},
      {within_01, "why", "the reference is known to 0.1 % only"}},
     {"b, 10 modes at 0.1 kHz, ≤ 0.98 %, 2 s per s", "perhaps for less a, 10 modes",
      "within 0.1 %   cannot be decided: the reference is known to 0.1 % only"}},
    {"IsLeftOpenWhereNoWindowCanBeDecided",
     {{"a", "44100", "", "0.0095", "0.03", "", 1}},
     {{within_1, "why", "the reference is known to 3 % only"}}},
    {"NamesTheLongestWindowThatCanBeDecided",
     {{"a", "44100", "", "0.0095", "0.03", "", 1, "ok", {}, 0.95, "0.004"}},
     {{within_1, "why", "the reference is known to 3 % only; over the first 10 ms to 0.4 %"},
      {within_01, "why", "the reference is known to 3 % only"}}},
    {"NamesNoControlWhereNoneCompetes",
     with_controls,
     {{within_10, "scheme", "modal_two_point"},
      {within_10, "ties", ""},
      {within_01, "status", "none"}}},
    {"NamesAControlThatCompetes",
     with_controls,
     {{within_10, "scheme", "modal_two_point_trapezoidal"},
      {within_01, "scheme", "modal_two_point_trapezoidal"}},
     {},
     bench::compare::Controls::compete}};

class CheapestOf : public testing::TestWithParam<Cheapest> {};
TEST_P(CheapestOf, Cells) {
    const bench::study::Cells cells = cells_of(GetParam().cells);
    const auto answers = bench::compare::cheapest_of(cells, GetParam().controls);
    const bench::store::Table t = table_of(answers, cells);
    ASSERT_EQ(t.rows.size(), GetParam().cells[0].octaves.empty() ? 3u : 5u);
    for (const auto& [goal, column, expected] : GetParam().answers)
        EXPECT_EQ(t.text(goal, column), expected) << goal << " " << column;
    for (const char* line : GetParam().lines)
        EXPECT_TRUE(says(bench::store::text_of(cheapest_lines(answers, cells)), line)) << line;
}
INSTANTIATE_TEST_SUITE_P(, CheapestOf, testing::ValuesIn(cheapest),
                         [](const auto& one) { return one.param.name; });

std::vector<bool> front_of(const std::vector<Sample>& samples) {
    std::vector<bool> front;
    for (const bench::study::TabledCell& c : bench::compare::with_front(cells_of(samples)))
        front.push_back(c.pareto == true);
    return front;
}

TEST(Pareto, FlaggedFailedAndUnknownCellsAreOnNoFrontAndKeepNoneFromIt) {
    EXPECT_EQ(front_of({{"a", "1", "", "0.01", "", "", 2},
                        {"b", "1", "psi_gap", "0.001", "", "", 1},
                        {"c", "1", "", "0.001", "", "", 1, "diverged"},
                        {"d", "1", "", "0.3", "", "", 3}}),
              (std::vector<bool>{true, false, false, false}));
    EXPECT_EQ(front_of({{"a", "1", "", "0.1", "0.95", "", 2}}), (std::vector<bool>{false}));
}

TEST(Pareto, ErrorsBelowTheCertificateAreATieAndSoIsADifferenceWithinIt) {
    EXPECT_EQ(
        front_of({{"a", "1", "", "1e-3", "0.01", "", 1}, {"b", "1", "", "1e-4", "0.01", "", 2}}),
        (std::vector<bool>{true, false}));
    EXPECT_EQ(
        front_of({{"a", "1", "", "1e-3", "1e-5", "", 1}, {"b", "1", "", "1e-4", "1e-5", "", 2}}),
        (std::vector<bool>{true, true}));
    // of one cost: the more accurate stands alone only where that is certain
    EXPECT_EQ(
        front_of({{"a", "1", "", "0.020", "0.01", "", 1}, {"b", "1", "", "0.039", "0.01", "", 1}}),
        (std::vector<bool>{true, true}));
    EXPECT_EQ(
        front_of({{"a", "1", "", "0.020", "0.01", "", 1}, {"b", "1", "", "0.041", "0.01", "", 1}}),
        (std::vector<bool>{true, false}));
}

TEST(ConvergenceTable, LeavesOutWhatTheReferenceIsNotCertainTo) {
    const bench::store::Table t =
        bench::compare::convergence_table(cells_of({{"a", "100", "", "0.16", "0.005", "", 1},
                                                    {"a", "200", "", "0.04", "0.005", "", 1},
                                                    {"a", "400", "", "0.01", "0.005", "", 1},
                                                    {"a", "800", "", "0.004", "0.005", "", 1}}));
    ASSERT_EQ(t.rows.size(), 2u);  // of the headline's tap over 50 ms, of the nut over 10 ms
    EXPECT_EQ(t.text(0, "points"), "3");
    EXPECT_NEAR(t.number(0, "order"), 2, 1e-9);
}

// ---- The errors of a cell

Trace trace_of(const std::vector<std::vector<double>>& taps) {
    Trace t;
    t.tap_rate = 44100;
    t.rows = t.stride = static_cast<long>(taps.front().size());
    for (std::size_t k = 0; k < taps.size(); ++k) {
        t.names.push_back("tap" + std::to_string(k));
        t.tap.insert(t.tap.end(), taps[k].begin(), taps[k].end());
    }
    return t;
}
std::vector<double> tone(double hertz, long rows) {
    std::vector<double> x;
    for (long n = 0; n < rows; ++n)
        x.push_back(std::sin(2 * M_PI * hertz * static_cast<double>(n) / 44100));
    return x;
}
TEST(Errors, AWindowEndsWhereItsNameSays) {
    const long rows = 4410;  // 100 ms
    const std::vector<double> truth = tone(1000, rows);
    const auto wrong_at = [&](double seconds) {  // in one row
        std::vector<double> x = truth;
        x[std::lround(seconds * 44100)] += 1;
        return bench::study::errors_of(trace_of({truth, x}), trace_of({truth, truth}));
    };
    const std::pair<const char*, double> ends[] = {{"error_l2_10ms", 0.010},
                                                   {"error_l2_50ms", 0.050}};
    for (const auto& [column, end] : ends) {
        EXPECT_GT(wrong_at(end - 1.0 / 44100)[1][bench::study::measure(column)], 0) << column;
        EXPECT_EQ(wrong_at(end)[1][bench::study::measure(column)], 0) << column;
        EXPECT_EQ(wrong_at(end - 1.0 / 44100)[0][bench::study::measure(column)], 0)
            << column;  // another tap
    }
    EXPECT_GT(wrong_at(0.0999)[1][bench::study::measure("error_l2_whole")], 0);
}

// What is wrong before `from` is in no error, and a window is as long as its name says from there
// on.
TEST(Errors, BeginWhereTheLastExcitationEnds) {
    const std::vector<double> truth = tone(1000, 8820);
    const auto wrong_at = [&](double seconds) {
        std::vector<double> x = truth;
        x[std::lround(seconds * 44100)] += 1;
        return bench::study::errors_of(trace_of({x}), trace_of({truth}), {}, 0.05)[0];
    };
    for (const char* column :
         {"error_l2_10ms", "error_l2_50ms", "error_l2_whole", "third_octave_db", "decay_db"})
        EXPECT_EQ(wrong_at(0.0499)[bench::study::measure(column)], 0) << column;
    EXPECT_GT(wrong_at(0.0501)[bench::study::measure("error_l2_10ms")], 0);
    EXPECT_EQ(wrong_at(0.0601)[bench::study::measure("error_l2_10ms")], 0);
    EXPECT_GT(wrong_at(0.0999)[bench::study::measure("error_l2_50ms")], 0);
    Scene plucked = read_scene("tanpura_drone");  // at 0, 1.2, 1.8 and 2.4 s, each for 50 ms
    EXPECT_DOUBLE_EQ(free_from(plucked), 2.45);
    plucked.duration = 1.0;
    EXPECT_DOUBLE_EQ(free_from(plucked), 0.05);  // what begins later is not in the run
    plucked.duration = 0.07;
    EXPECT_DOUBLE_EQ(bench::study::headline_window(plucked), 10e-3);
    EXPECT_EQ(free_from(read_scene("tanpura_c3_release")), 0);
}

TEST(Errors, OfATonePitchedAndLoudAsTheyAre) {
    const long rows = 44100;
    std::vector<double> loud = tone(1000, rows);
    for (double& v : loud) v *= 2;
    const bench::study::Errors e = bench::study::errors_of(
        trace_of({loud, tone(1500, rows)}), trace_of({tone(1000, rows), tone(1000, rows)}));
    EXPECT_NEAR(e[0][bench::study::measure("third_octave_db")], 20 * std::log10(2), 1e-6);
    EXPECT_NEAR(e[0][bench::study::measure("centroid_hz")], 0, 1e-6);
    EXPECT_NEAR(e[1][bench::study::measure("centroid_hz")], 500, 1);
    EXPECT_NEAR(e[0][bench::study::measure("error_l2_whole")], 1, 1e-12);
}

// ---- Flags

TEST(Flags, EachIsRaisedAboveItsThresholdAndSaysWhatHappened) {
    bench::study::Summary s{};
    s.largest_contact_force = 30;
    s.smallest_contact_force = -0.9e-6 * 30;
    s.energy_residual_accumulated = 0.9e-6;
    s.facts = {{"psi_out_of_contact", 0.9e-9, ""}, {"modes_above_nyquist", 0, ""}};
    EXPECT_EQ(names_of(bench::study::flags_of(s)), "");
    s.smallest_contact_force = -0.55;
    EXPECT_EQ(names_of(bench::study::flags_of(s)), "adhesion");
    EXPECT_EQ(bench::study::flags_of(s)[0].sentence,
              "the contact pulls with 0.55 N, and pushes with 30 N at most: only a contact with "
              "loss may pull");
    s.facts = {{"psi_out_of_contact", 1.1e-9, ""}, {"modes_above_nyquist", 12, ""}};
    s.energy_residual_accumulated = 1.1e-6;
    EXPECT_EQ(names_of(bench::study::flags_of(s)), "adhesion psi_gap energy modes_above_nyquist");
    s.smallest_contact_force = s.energy_residual_accumulated = std::nan("");
    s.facts.clear();
    EXPECT_EQ(names_of(bench::study::flags_of(s)), "");
    s.smallest_contact_force = -0.9e-9, s.largest_contact_force = 0;  // rounding
    EXPECT_EQ(names_of(bench::study::flags_of(s)), "");
}

// ---- The table of cells

TEST(CellsTable, EachColumnHasWhatItsNameSays) {
    bench::study::Plan plan;
    bench::study::Point& point = plan.points.emplace_back();
    point.scene = bench::compare::load_scene("tanpura_c3_release", {}, 0.1);
    const std::size_t taps = point.scene.taps.size(), measures_of = bench::study::measures().size();
    const auto errors_from = [&](double start) {
        bench::study::Errors e(taps, std::vector<double>(measures_of));
        for (std::size_t tap = 0; tap < taps; ++tap)
            for (std::size_t k = 0; k < measures_of; ++k)
                e[tap][k] = start + 100 * static_cast<double>(tap) + static_cast<double>(k);
        return e;
    };
    bench::study::Cell cell{};
    static const bench::compare::Catalogue catalogue;
    cell.scheme = &catalogue.find("modal_two_point");
    cell.settings.sample_rate = 88200;
    bench::study::Record record;
    bench::study::Summary& s = cell.summary;
    s.modes = 133, s.dofs = 266, s.steps = 8820, s.rows = 4411, s.duration = 0.1;
    s.energy_residual_per_step = 1e-13, s.energy_residual_accumulated = 2e-12;
    s.smallest_contact_force = -0.25, s.largest_contact_force = 30, s.deepest_penetration = 3e-8;
    s.facts = {{"static_compliance", 0.9, ""}};
    cell.errors = errors_from(1000);
    record.against.floor = errors_from(5000);
    for (std::size_t tap = 0; tap < taps; ++tap) {
        const double x = 0.01 * static_cast<double>(tap + 1);
        record.against.trust.figure.push_back({x, x + 0.001, x + 0.002});
    }
    cell.clock.wall = {5, 0.02, 0.016, 0.026};
    cell.clock.processor = {5, 0.018, 0.015, 0.025};
    cell.clock.worst_block = 0.4;
    record.cell = cell;
    plan.jobs.push_back({&point, cell});
    const bench::study::Cells cells =
        bench::compare::with_front(bench::study::cells_of(plan, {record}));
    const bench::store::Table t = bench::study::table_of(cells, bench::study::Contents::everything);
    const std::pair<const char*, double> expected[] = {{"rate", 88200},
                                                       {"modes", 133},
                                                       {"cost_s_per_s", 0.2},
                                                       {"cost_lower", 0.16},
                                                       {"cost_upper", 0.26},
                                                       {"processor_s_per_s", 0.18},
                                                       {"processor_lower", 0.15},
                                                       {"processor_upper", 0.25},
                                                       {"wall_seconds", 0.02},
                                                       {"wall_seconds_lower", 0.016},
                                                       {"wall_seconds_upper", 0.026},
                                                       {"ns_per_step", 0.02e9 / 8820},
                                                       {"times_real_time", 5},
                                                       {"worst_block_of_deadline", 0.4},
                                                       {"repeats", 5},
                                                       {"energy_residual_per_step", 1e-13},
                                                       {"energy_residual_accumulated", 2e-12},
                                                       {"smallest_contact_force", -0.25},
                                                       {"deepest_penetration", 3e-8},
                                                       {"dofs", 266},
                                                       {"state_bytes", 2128},
                                                       {"steps", 8820},
                                                       {"fact_static_compliance", 0.9}};
    for (const auto& [column, value] : expected)
        EXPECT_NEAR(t.number(0, column), value, 1e-12 * std::abs(value)) << column;
    EXPECT_EQ(t.text(0, "flags"), "adhesion");
    EXPECT_EQ(t.text(0, "pareto"), "0");  // it pulls
    EXPECT_EQ(point.scene.taps[0].name, "nut");
    ASSERT_EQ(point.scene.taps[2].name, "bridge");
    for (std::size_t k = 0; k < measures_of; ++k) {
        const bench::study::Measure& m = bench::study::measures()[k];
        const double own = static_cast<double>(k);
        EXPECT_EQ(t.number(0, m.column), 1000 + own + (m.column == "third_octave_db" ? 200 : 0))
            << m.column;
        for (std::size_t tap = 0; tap < taps; ++tap)
            EXPECT_EQ(cells[0].figure(k, point.scene.taps[tap].name).value,
                      1000 + own + 100 * static_cast<double>(tap));
        if (m.less_is_better) { EXPECT_EQ(cells[0].figure(k, "bridge").floor, 5200 + own); }
    }
    const auto certificate = [&](const char* measure, const char* tap) {
        return cells[0].figure(bench::study::measure(measure), tap).certificate;
    };
    EXPECT_DOUBLE_EQ(certificate("error_l2_10ms", ""), 0.01);
    EXPECT_DOUBLE_EQ(certificate("error_l2_50ms", "bridge"), 0.031);
    EXPECT_DOUBLE_EQ(certificate("error_l2_whole", "thread"), 0.042);
}

TEST(Facts, OfSeveralStringsTheLeastContactForceAndTheMostOfAnythingElseStand) {
    const std::vector<Fact> facts{{"string.0.smallest_contact_force", -1, "N"},
                                  {"string.1.smallest_contact_force", -2, "N"},
                                  {"string.2.smallest_contact_force", 0, "N"},
                                  {"string.0.deepest_penetration", 1, "m"},
                                  {"string.1.deepest_penetration", 3, "m"},
                                  {"string.2.deepest_penetration", 2, "m"},
                                  {"contact_points", 5, ""},
                                  {"string.0.contact_points", 7, ""}};
    EXPECT_EQ(fact_of(facts, "smallest_contact_force"), -2);
    EXPECT_EQ(fact_of(facts, "deepest_penetration"), 3);
    EXPECT_EQ(fact_of(facts, "contact_points"), 5);  // said of all
    EXPECT_TRUE(std::isnan(fact_of(facts, "points")));
}

// ---- Equal modes

bench::compare::CompareRequest request_for(std::vector<std::string> schemes,
                                           std::vector<double> rates) {
    bench::compare::CompareRequest r;
    r.scene = "tanpura_c3_release";
    r.schemes = std::move(schemes);
    r.rates = std::move(rates);
    return r;
}

bench::study::Plan planned(const bench::compare::CompareRequest& r, const Scene& scene) {
    static const bench::compare::Catalogue catalogue;
    bench::study::Plan plan;
    bench::study::Point common;
    common.scene = scene;
    add_jobs(plan, r, catalogue, common, {});
    return plan;
}

bench::study::Plan plan_for(const std::string& scene, const std::vector<std::string>& schemes,
                            int modes = 0) {
    bench::compare::CompareRequest r = request_for(schemes, {88200, 176400});
    r.scene = scene;
    if (modes > 0) r.modes = {modes};
    r.search = false;
    return planned(r, bench::compare::load_scene(scene, {}, {}));
}

TEST(Plan, TheReferenceAndEveryCellCarryTheSameModes) {
    for (const char* scene : {"two_point_bridge", "tanpura_c3_release", "free_string"}) {
        const bench::study::Plan plan =
            plan_for(scene, {"modal_two_point", "modal_spatial_newton"});
        const int modes = plan.points.front().references.front().settings.modes;
        EXPECT_EQ(modes, scene == std::string("two_point_bridge") ? 94 : 133);
        ASSERT_EQ(plan.jobs.size(), 4u);
        for (const bench::study::Job& job : plan.jobs) {
            const bench::study::Cell& c = job.cell;
            EXPECT_EQ(c.settings.modes, modes) << scene << " " << c.scheme->name;
            EXPECT_EQ(make_scheme(*c.scheme, job.point->scene, c.settings)->dofs() >= 2 * modes,
                      true);
        }
        EXPECT_TRUE(plan.notes.empty());
    }
}

TEST(Plan, ASchemeWhosePointsOfContactAreItsNodesKeepsItsOwnOnAProfileAndANoteSaysSo) {
    const bench::study::Plan plan =
        plan_for("sitar_parabola", {"modal_spatial_newton", "finite_difference_explicit"});
    EXPECT_EQ(plan.points.front().references.front().settings.modes, 94);
    for (const bench::study::Job& job : plan.jobs)
        EXPECT_EQ(job.cell.settings.modes,
                  std::string("modal_spatial_newton") == job.cell.scheme->name ? 0 : 94);
    ASSERT_EQ(plan.notes.size(), 1u);
    EXPECT_TRUE(says(plan.notes[0], "modal_spatial_newton carries 421 modes"));
    const bench::study::Plan of_300 = plan_for("sitar_parabola", {"modal_spatial_newton"}, 300);
    EXPECT_TRUE(of_300.notes.empty());
    for (const bench::study::Job& job : of_300.jobs) EXPECT_EQ(job.cell.settings.modes, 300);
    EXPECT_EQ(of_300.points.front().references.front().settings.modes, 300);
}

TEST(Plan, RatesThatHaveRowsInCommonAreOnOnePoint) {
    bench::compare::CompareRequest r = request_for({"modal_two_point", "exact_contact"}, {});
    r.search = false;
    const Scene scene = bench::compare::load_scene(r.scene, {}, 0.01);
    // rows a second, rates; 0: continuous time
    using Kinds = std::vector<std::pair<double, std::vector<double>>>;
    const auto kinds = [&](const std::vector<double>& rates) {
        r.rates = rates;
        Kinds all;
        const bench::study::Plan plan = planned(r, scene);
        for (const bench::study::Point& point : plan.points) {
            all.emplace_back(point.references.front().settings.tap_rate, std::vector<double>());
            for (const bench::study::Job& job : plan.jobs) {
                if (job.point != &point) continue;
                EXPECT_EQ(job.cell.settings.tap_rate, all.back().first);
                all.back().second.push_back(job.cell.settings.sample_rate);
            }
        }
        return all;
    };
    EXPECT_EQ(kinds({88200, 132300}), (Kinds{{44100, {88200, 132300, 0}}}));
    EXPECT_EQ(kinds({44100, 22050}), (Kinds{{22050, {22050, 44100, 0}}}));
    EXPECT_EQ(kinds({96000, 44100, 48000, 88200}),
              (Kinds{{44100, {44100, 88200, 0}}, {48000, {48000, 96000}}}));
}

TEST(Plan, AnOptionInItsShortFormGoesToSchemesAndNeverToTheReference) {
    auto r = request_for({"modal_two_point", "modal_explicit_penalty"}, {44100});
    r.options = {{"", "compliance", "matched"}};
    const Scene scene = bench::compare::load_scene(r.scene, {}, {});
    const OptionValues matched{{"compliance", "matched"}};
    const auto reference = [&] { return planned(r, scene).points.front().references.front(); };
    EXPECT_TRUE(declares(*reference().scheme, "compliance"));
    EXPECT_EQ(reference().settings.options, OptionValues());
    for (const bench::study::Job& job : planned(r, scene).jobs)
        EXPECT_EQ(job.cell.settings.options, job.cell.scheme->name == std::string("modal_two_point")
                                                 ? matched
                                                 : OptionValues());
    r.options.push_back({reference().scheme->name, "compliance", "matched"});
    EXPECT_EQ(reference().settings.options, matched);
}

// ---- The truth: the modes that the reference is given

bench::study::Truth truth_of(const Scene& scene, int modes) {
    std::vector<bench::study::ReferenceChoice> references =
        plan_for(scene.name, {"modal_two_point"}).points.front().references;
    for (auto& c : references) c.kept = false;
    return bench::study::run_truth(references, scene, modes, 1, bench::store::Listener());
}
bench::study::Truth truth_of(int modes, double duration = 0.01) {
    return truth_of(bench::compare::load_scene("tanpura_c3_release", {}, duration), modes);
}

TEST(Truth, ModesAreDoubledUntilWhatIsLeftOutMovesTheHeadlineByLittleEnough) {
    // high modes decay faster, so that fewer are needed
    const Scene scene =
        bench::compare::load_scene("tanpura_c3_release", {"string.0.damping.sigma3=2e-5"}, 0.01);
    const auto truth = truth_of(scene, 0);
    const int nut = 0;
    const auto left = [&](const bench::study::Reference& r) { return r.trust.left_out[nut][0]; };
    EXPECT_LT(left(truth.reference), bench::study::settled);
    ASSERT_GE(truth.coarser.size(), 2u);
    EXPECT_GE(left(truth.coarser.back()), bench::study::settled);
    for (std::size_t k = 0; k < truth.coarser.size(); ++k)
        EXPECT_EQ(truth.coarser[k].choice.settings.modes, 133 << k);
    EXPECT_FALSE(says(truth.description, "too long"));
    // by the reference itself: what it leaves out is what it says, or less
    Settings twice = truth.reference.choice.settings;
    twice.modes *= 2;
    const jvari::Run finer = run(exact_contact, scene, twice);
    const double is = relative_difference(truth.reference.run.trace.column(nut),
                                          finer.trace.column(nut), 44100, 10e-3);
    EXPECT_LT(is, left(truth.reference));
    const double was = relative_difference(truth.coarser.back().run.trace.column(nut),
                                           finer.trace.column(nut), 44100, 10e-3);
    EXPECT_LT(was, left(truth.coarser.back()));
    EXPECT_GT(was, 0.02 * left(truth.coarser.back()));
}

// Sixteen contacts that the string couples take 60 times as long with 1504 modes as with 752, and
// more than half a minute: it ends before.
TEST(Truth, DoublingEndsSoonerWhereManyBarriersAreCoupled) {
    Scene scene = bench::compare::load_scene("two_point_bridge", {}, 0.1);
    const LumpedBarrier one = std::get<LumpedBarrier>(scene.strings[0].barriers[0]);
    scene.strings[0].barriers.clear();
    for (int k = 0; k < 16; ++k) {
        LumpedBarrier b = one;
        b.position = 1e-3 * (1 + k), b.width = 0, b.height = -4e-3 * b.position * b.position;
        scene.strings[0].barriers.emplace_back(b);
    }
    const auto truth = truth_of(scene, 0);
    EXPECT_LE(truth.reference.choice.settings.modes, 752) << truth.description;
    EXPECT_TRUE(says(truth.description, "too long"));
}

TEST(Truth, WhereOneDoublingTakesTooLongHalfAsManyTellWhatIsLeftOut) {
    const Scene scene = bench::compare::load_scene("free_string", {}, 30);
    auto references = plan_for("free_string", {"modal_two_point"}).points.front().references;
    for (auto& c : references) c.kept = false, c.settings.tap_rate = 100;
    const auto truth = bench::study::run_truth(references, scene, 0, 1, bench::store::Listener());
    EXPECT_EQ(truth.reference.choice.settings.modes, 133);
    ASSERT_EQ(truth.coarser.size(), 1u);
    EXPECT_EQ(truth.coarser[0].choice.settings.modes, 66);
    EXPECT_GT(truth.reference.trust.left_out[0][1], 0);
    EXPECT_TRUE(says(truth.description, "twice as many would take too long"));
}

TEST(Truth, AGivenNumberIsTakenWithItsHalfAndItsQuarterToTellWhatItLeavesOut) {
    const auto truth = truth_of(200);
    EXPECT_EQ(truth.reference.choice.settings.modes, 200);
    ASSERT_EQ(truth.coarser.size(), 2u);
    EXPECT_EQ(truth.coarser[0].choice.settings.modes, 50);
    EXPECT_EQ(truth.coarser[1].choice.settings.modes, 100);
}

TEST(Truth, AMatchedCellIsInNoModelWithComplianceOfItsOwn) {
    const auto truth = truth_of(40, 1e-3);  // matched, 10, 20 and 40 modes
    bench::study::Reference model = truth.reference;
    model.choice.settings.options.clear();
    const auto model_of = [&](int modes, const OptionValues& options) {
        model.choice.settings.modes = modes;
        const Settings settings{44100, 44100, modes, options};
        return bench::study::of_modes({truth.reference.choice.scheme, settings}, model, truth);
    };
    const OptionValues matched = {{"compliance", "matched"}};
    EXPECT_EQ(model_of(20, matched), &truth.coarser[1]);
    EXPECT_EQ(model_of(40, matched), &truth.reference);
    EXPECT_EQ(model_of(30, matched), nullptr);
    EXPECT_EQ(model_of(30, {}), &model);
    EXPECT_EQ(model_of(20, {}), &model);
}

TEST(Truth, WhatIsLeftAfterDoublingsFollowsTheRateThatTheyShow) {
    const auto left = [](std::vector<double> changes, bool matched) {
        return left_after(changes, matched);
    };
    EXPECT_NEAR(left({3e-3, 2e-3}, false), 4e-3, 1e-12);  // 2/3 + 4/9 + ...
    // no better than order one after either of the last two, since one pair can agree by chance
    EXPECT_NEAR(left({1e-2, 1e-3, 4e-4}, false), 6e-4, 1e-12);
    EXPECT_NEAR(left({1e-2, 1e-3, 6e-4}, false), 9e-4, 1e-12);
    EXPECT_NEAR(left({1e-3}, false), 2.5e-3, 1e-12);  // one doubling: order one half
    EXPECT_NEAR(left({1.1e-3, 1e-3}, false), 2.75e-3, 1e-12);
    EXPECT_NEAR(left({1e-2, 1e-3, 3e-3}, false), 7.5e-3, 1e-12);  // they converge unevenly
    EXPECT_TRUE(std::isnan(left({2e-3, 1e-3, 3e-3}, false)));     // or not at all
    EXPECT_TRUE(std::isnan(left({1e-3, 1e-3}, true)));
    EXPECT_TRUE(std::isnan(left({}, true)));
    EXPECT_EQ(left({0, 0}, false), 0);
    EXPECT_NEAR(left({3e-3, 1e-3}, true), 2.5e-3, 1e-12);  // matched modes converge unevenly
    EXPECT_NEAR(left({1e-3}, true), 7e-3, 1e-12);
    EXPECT_NEAR(left({1e-2, 9e-4, 8e-4}, true), 2.25e-3, 1e-12);
}

// Matched solutions agree with one another also where matching is wrong: own ones, extrapolated,
// do not agree with them there.
TEST(Truth, AMatchedOneLeavesOutNoLessThanItLiesBesideOwnModesExtrapolated) {
    EXPECT_EQ(no_less(1e-4, 1e-2, 1e-3), 1e-2);
    EXPECT_EQ(no_less(1e-4, 1e-3, 1e-2), 1e-4);  // the extrapolation does not know better
    EXPECT_EQ(no_less(1e-1, 1e-2, 1e-3), 1e-1);
    EXPECT_TRUE(std::isnan(no_less(nan, 1e-2, 1e-3)));
    const std::vector<double> own = {1 + 1.0 / 40, -3 + 2.0 / 40},
                              half = {1 + 1.0 / 20, -3 + 2.0 / 20};
    EXPECT_NEAR(extrapolated(own, half)[0], 1, 1e-15);
    EXPECT_NEAR(extrapolated(own, half)[1], -3, 1e-15);

    const auto truth = truth_of(532);
    const int modes = truth.reference.choice.settings.modes, bridge = 2;
    ASSERT_EQ(truth.own.size(), 2u);
    const auto apart = [&](const Trace& a, const Trace& b) {
        return relative_difference(a.column(bridge), b.column(bridge), 44100, 10e-3);
    };
    const Trace& matched = truth.reference.run.trace;
    // nearer than half as many own ones by far, or the extrapolation is not of their order
    EXPECT_LT(apart(truth.own[0], matched), 0.4 * apart(truth.own[1], matched)) << modes;
    EXPECT_LT(apart(truth.own[0], matched), apart(truth.own[1], truth.own[0])) << modes;
    EXPECT_LT(truth.reference.trust.left_out[bridge][0], 1e-2) << modes;
}

// The third derivative at the end, of modes that fall as 1/i^2, is a sum that grows without end.
TEST(Truth, TheForceOfASharpCornerOnAStiffStringIsUnknown) {
    const Scene scene =
        bench::compare::load_scene("free_string",
                                   {"string.0.start.smoothing=0", "string.0.damping={law=\"none\"}",
                                    "string.0.bending_stiffness=6e-3"},
                                   0.0105);
    const auto truth = truth_of(scene, 1024);
    ASSERT_GE(truth.coarser.size(), 2u) << truth.description;
    EXPECT_TRUE(std::isnan(truth.reference.trust.left_out[0][0])) << truth.description;
    EXPECT_LT(truth.reference.trust.left_out[1][0], 1e-3);  // its displacement is known
    EXPECT_TRUE(says(truth.description, "smoothing")) << truth.description;
}

TEST(Truth, WithoutADoublingAndACertificateItsUncertaintyIsUnknown) {
    // no certificate is of it
    const Scene scene =
        bench::compare::load_scene("tanpura_c3_release", {"string.0.tension=40"}, 1e-3);
    const auto truth = truth_of(scene, 1);  // nothing is below one mode
    EXPECT_TRUE(truth.coarser.empty());
    EXPECT_FALSE(truth.reference.trust.any());
    EXPECT_TRUE(std::isnan(truth.reference.trust.of_scene(0, 2)));
}

// ---- What is tried where nothing is named

std::vector<bench::study::Cell> sought(bench::compare::CompareRequest r,
                                       const std::vector<std::string>& set = {},
                                       std::vector<std::string>* notes = nullptr) {
    const bench::study::Plan plan = planned(r, bench::compare::load_scene(r.scene, set, 0.01));
    if (notes) *notes = plan.notes;
    std::vector<bench::study::Cell> cells;
    for (const bench::study::Job& job : plan.jobs) cells.push_back(job.cell);
    return cells;
}
std::vector<std::string> names_of(const std::vector<bench::study::Cell>& cells) {
    std::vector<std::string> names;
    for (const auto& c : cells)
        names.push_back(bench::store::options_text(c.settings.options) + " " +
                        std::to_string(c.settings.modes) + " " +
                        std::to_string(std::lround(c.settings.sample_rate)));
    return names;
}

TEST(Search, MoreModesWhereTheyLieBelowHalfTheRateAndBothFormsOfCompliance) {
    EXPECT_EQ(
        names_of(sought(request_for({"modal_two_point"}, {44100, 88200, 176400}))),
        (std::vector<std::string>{
            "compliance=own 133 44100", "compliance=own 133 88200", "compliance=own 133 176400",
            "compliance=own 200 88200", "compliance=own 200 176400", "compliance=own 266 176400",
            "compliance=matched 133 44100", "compliance=matched 133 88200",
            "compliance=matched 133 176400", "compliance=matched 200 88200",
            "compliance=matched 200 176400", "compliance=matched 266 176400"}));
    // a grid takes its nodes from the rate
    EXPECT_EQ(
        names_of(sought(request_for({"finite_difference_explicit"}, {176400}))),
        (std::vector<std::string>{"compliance=own 133 176400", "compliance=matched 133 176400"}));
}

TEST(Search, WhatIsNamedStands) {
    auto r = request_for({"modal_two_point", "modal_quadratised"}, {88200});
    r.modes = {60, 133};
    r.options = {{"modal_two_point", "compliance", "own"},
                 {"modal_quadratised", "compliance", "own"},
                 {"modal_quadratised", "compliance", "matched"}};
    EXPECT_EQ(
        names_of(sought(r)),
        (std::vector<std::string>{"compliance=own 60 88200", "compliance=own 133 88200",
                                  "compliance=own 60 88200", "compliance=own 133 88200",
                                  "compliance=matched 60 88200", "compliance=matched 133 88200"}));
    auto none = request_for({"modal_two_point"}, {88200});
    none.search = false;
    EXPECT_EQ(names_of(sought(none)), (std::vector<std::string>{" 133 88200"}));
    none.search = true;
    // a reference of the cell's own modes cannot tell what they leave out
    none.reference_modes.reset();
    EXPECT_EQ(names_of(sought(none)), (std::vector<std::string>{" 133 88200"}));
}

TEST(Search, MatchedComplianceThatWasNotTriedIsSaidOnceWithItsReason) {
    std::vector<std::string> notes;
    const auto cells = sought(request_for({"modal_two_point", "modal_spatial_newton"}, {44100}),
                              {"string.0.barrier.0.contact_loss=1"}, &notes);
    for (const auto& c : cells) EXPECT_TRUE(c.settings.options.empty());
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0],
              "modal_two_point, modal_spatial_newton: run as published only, for "
              "compliance=matched leaves out contact loss");
}

TEST(Search, AReferenceTakesOneValueOfAnOption) {
    auto r = request_for({"modal_two_point"}, {44100});
    r.options = {{"exact_contact", "compliance", "own"},
                 {"exact_contact", "compliance", "matched"}};
    EXPECT_THROW(sought(r), bench::store::UsageError);
}

bench::study::Cell tried(const char* scheme, double rate, int modes) {
    static const bench::compare::Catalogue catalogue;
    bench::study::Cell c{&catalogue.find(scheme), {rate, 44100, modes, {}}};
    c.summary.modes = modes;
    c.summary.dofs = 2 * modes;
    c.summary.steps = std::lround(rate * 0.05);
    c.searched = true;
    return c;
}
std::vector<bool> needed(std::vector<bench::study::Cell> cells, const std::vector<double>& errors,
                         double certificate = 0) {
    bench::compare::mark_needed(cells, errors, certificate);
    std::vector<bool> all;
    for (const auto& c : cells) {
        all.push_back(c.needed);
        EXPECT_EQ(c.needed, c.reason.empty());
    }
    return all;
}

TEST(Search, ACellIsLeftOutWhereOneThatSurelyCostsLessDoesAsWell) {
    const auto two_point = [](double rate, int modes) {
        return tried("modal_two_point", rate, modes);
    };
    using Flags = std::vector<bool>;
    const auto more = [&](double rate, int modes) {
        bench::study::Cell c = two_point(rate, modes);
        c.added = true;
        return c;
    };
    // of one scheme: as many modes at a lower rate, or fewer
    EXPECT_EQ(
        needed({two_point(44100, 100), more(88200, 100), more(176400, 100)}, {0.05, 0.049, 0.04}),
        (Flags{true, false, true}));
    // neither surely costs less
    EXPECT_EQ(needed({two_point(44100, 200), more(88200, 100)}, {0.05, 0.05}), (Flags{true, true}));
    // its convergence is asked for
    EXPECT_EQ(needed({two_point(44100, 100), two_point(88200, 100)}, {0.05, 0.05}),
              (Flags{true, true}));
    // it keeps 1 %, which the cheaper one does not
    EXPECT_EQ(needed({two_point(44100, 100), more(88200, 100)}, {0.0105, 0.0095}),
              (Flags{true, true}));
    // nor does it
    EXPECT_EQ(needed({two_point(44100, 100), more(88200, 100)}, {0.0105, 0.0095}, 1e-3),
              (Flags{true, false}));
    // the finest accuracy is kept: more of it is not needed
    EXPECT_EQ(needed({two_point(44100, 100), more(88200, 100)}, {0.0009, 0.0001}),
              (Flags{true, false}));
    // of another scheme: a thirty-second of the steps times the state
    const auto grid = [](double rate, int nodes) {
        return tried("finite_difference_theta", rate, nodes);
    };
    EXPECT_EQ(
        needed({two_point(44100, 100), grid(44100, 3000), grid(88200, 1600)}, {0.05, 0.05, 0.05}),
        (Flags{true, true, false}));
    // what fails is a finding at the modes that the scheme takes unasked, and none beyond
    std::vector<bench::study::Cell> failed{two_point(44100, 100), two_point(88200, 100),
                                           two_point(88200, 200)};
    failed[2].added = true;
    failed[1].reason = failed[2].reason = "diverged";
    bench::compare::mark_needed(failed, {0.05, HUGE_VAL, HUGE_VAL}, 0);
    EXPECT_TRUE(failed[1].needed);
    EXPECT_FALSE(failed[2].needed);
}

// A table of measured modes is the string: nothing is left out of it, and another solver tells how
// far it is solved.
TEST(Truth, OfMeasuredModesHasAllOfThemAndIsConfirmedByAnotherSolver) {
    Scene scene = bench::compare::load_scene("tanpura_c3_release", {}, 0.003);
    String& s = scene.strings.front();
    const Modes modes = modes_of(s, 40);
    TableDamping table;
    for (int i = 0; i < 40; ++i) {
        table.frequency_hz.push_back(modes.omega0[i] / (2 * std::numbers::pi));
        table.decay_rate.push_back(modes.sigma[i]);
    }
    s.damping = table;
    const auto truth = truth_of(scene, 0);
    EXPECT_EQ(truth.reference.choice.settings.modes, 40);
    EXPECT_EQ(truth.reference.choice.settings.options, OptionValues());
    EXPECT_TRUE(says(truth.description, "40 modes, all that were measured: what lies above"))
        << truth.description;
    EXPECT_EQ(truth.limit_hz, std::get<TableDamping>(s.damping).frequency_hz.back());
    EXPECT_FALSE(says(truth.description, "too long")) << truth.description;
    EXPECT_EQ(truth.reference.trust.against, "sundials");
    EXPECT_GT(truth.reference.trust.of_scene(0, 2), 0);
    EXPECT_LT(truth.reference.trust.of_scene(0, 2), 1e-6);
}

}  // namespace
}  // namespace jvari
