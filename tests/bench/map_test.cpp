// Maps of suites: the file, bisection, boundaries against theory, and that a map which was stopped
// ends like one that was not.
#include <cmath>
#include <thread>

#include "bench/store/encoding.hpp"
#include "bench/suite/maps.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/scene_file.hpp"
#include "tests/command_line.hpp"
#include "tests/suite_text.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

// ---- The file

TEST(MapFile, AxesAreListedOrSpacedByEqualRatios) {
    const bench::suite::Suite s = bench::suite::parse_suite(R"(
        [[map]]
        name = "a"
        scene = "free_string"
        x = { key = "string.0.tension", from = 1e4, to = 1e16, points = 7 }
        y = { key = "modes", from = 10, to = 40, points = 3 }
        rate = 48000
        options = { grid = 100 }
        set = { "string.0.damping.law" = "none" }
    )",
                                                            "a.toml");
    ASSERT_EQ(s.maps.size(), 1u);
    const bench::suite::Map& m = s.maps[0];
    ASSERT_EQ(m.x.values.size(), 7u);
    EXPECT_EQ(m.x.at[1], 1e6);
    EXPECT_EQ(m.x.at[6], 1e16);
    EXPECT_EQ(m.y.values, (std::vector<std::string>{"10", "20", "40"}));
    EXPECT_TRUE(m.y.whole);
    EXPECT_FALSE(m.x.whole);
    EXPECT_TRUE(m.reproduce);
    EXPECT_EQ(
        m.fixed,
        (std::vector<bench::suite::Assignment>{
            {"rate", "48000"}, {"option:grid", "100"}, {"string.0.damping.law", "\"none\""}}));
}

TEST(MapFile, WhatItDoesNotKnowIsAnErrorWithFileLineAndKey) {
    const std::string head = "[[map]]\nname = \"a\"\nscene = \"b\"\n",
                      x = "x = { key = \"rate\", values = [1, 2] }\n";
    const std::pair<std::string, const char*> cases[] = {
        {"[[map]]\nname = \"a\"\n" + x, "a.toml:1: map.0: the key scene is missing"},
        {head + x + "schmes = [\"c\"]",
         "a.toml:5: map.0: unknown key \"schmes\"; did you mean \"schemes\"?"},
        {head + "x = { key = \"rate\", valeus = [1] }",
         "a.toml:4: map.0.x: unknown key \"valeus\"; did you mean \"values\"?"},
        {head + "x = { key = \"rate\" }", "a.toml:4: map.0.x: the key from is missing"},
        {head + "x = { key = \"rate\", from = 2, to = 1, points = 3 }",
         "map.0.x.to: found 1, expected more than from"},
        {head + "x = { key = \"rate\", from = 1, to = 2, points = 1 }",
         "map.0.x.points: found 1, expected 2 or more"},
        {head + "x = { key = \"rate\", from = 1, values = [1] }",
         "map.0.x.from: found 1, expected either values or from, to and points"},
        {head + "x = { key = \"rate\", values = [2, 1] }", "expected numbers that ascend"},
        {head + "x = { key = \"rate\", values = [-2] }",
         "a.toml:4: map.0.x.values.0: found -2, expected a number > 0"},
        {head + "x = { key = \"modes\", values = [2.5] }",
         "a.toml:4: map.0.x.values.0: found 2.5, expected a whole number from 1 to 9999999"},
        {head + x + "rate = 3",
         "map.0.x.key: found \"rate\", expected a key that is not set for all points as well"},
        {head + x + "reproduce = 1", "a.toml:5: map.0.reproduce: found 1, expected true or false"},
        {head + x + "theory = \"grid\"", "a.toml:5: map.0.theory: unknown theory \"grid\""},
        {head + "x = { key = \"string.0.damping.law\", values = [\"none\"] }\nrefine = 3",
         "map.0.refine: found 3, expected an axis x of numbers"},
        {head + x + head + x, "map.1.name: found \"a\", expected a name of its own"},
        {"[[map]]\nname = \"A b\"\nscene = \"b\"\n" + x, "a.toml:2: map.0.name"},
    };
    for (const auto& [text, expected] : cases) EXPECT_TRUE(says(refusal_of(text), expected));
}

// ---- Bisection

TEST(MapFile, MorePointsThanCanBeRunAreRefusedWithTheirNumber) {
    const std::string head =
        "[[map]]\nname = \"a\"\nscene = \"free_string\"\nschemes = [\"modal_two_point\", "
        "\"modal_quadratised\"]\n";
    const auto axis = [](const char* name, const std::string& points) {
        return name + std::string(" = { key = \"") + (*name == 'x' ? "rate" : "duration") +
               "\", from = 1, to = 2, points = " + points + " }\n";
    };
    EXPECT_EQ(refusal_of(head + axis("x", "9999999")),
              "a.toml:5: map.0.x.points: found 9999999, expected at most 1000000");
    EXPECT_EQ(refusal_of(head + axis("x", "10000") + axis("y", "1000")),
              "a.toml:1: map.0: found 20000000 points, expected at most 1000000");
    EXPECT_EQ(refusal_of(head + axis("x", "500") + axis("y", "1000")), "read");
}

TEST(Bisection, FindsAKnownBoundaryToItsStatedWidth) {
    int calls = 0;
    const auto past_pi = [&calls](double x) {
        return ++calls,
               x < 3.14159265 ? bench::study::Verdict::sound : bench::study::Verdict::diverged;
    };
    const bench::suite::Bracket b = bench::suite::bisect(
        {1, 100, bench::study::Verdict::sound, bench::study::Verdict::diverged}, 20, false,
        past_pi);
    EXPECT_EQ(calls, 20);
    EXPECT_LT(b.low, 3.14159265);
    EXPECT_GE(b.high, 3.14159265);
    EXPECT_LT(b.high / b.low - 1, std::log(100) / (1 << 20) * 1.1);
}

TEST(Bisection, OfWholeNumbersEndsAtNeighbours) {
    const auto past = [](double x) {
        return x <= 137 ? bench::study::Verdict::sound : bench::study::Verdict::refused;
    };
    const bench::suite::Bracket b = bench::suite::bisect(
        {100, 400, bench::study::Verdict::sound, bench::study::Verdict::refused}, 60, true, past);
    EXPECT_EQ(b.low, 137);
    EXPECT_EQ(b.high, 138);
}

TEST(Bisection, WithAThirdOutcomeBetweenFindsWhereStabilityEnds) {
    const auto three = [](double x) {
        return x < 2   ? bench::study::Verdict::sound
               : x < 3 ? bench::study::Verdict::adhesive
                       : bench::study::Verdict::diverged;
    };
    const bench::suite::Bracket end = bench::suite::bisect(
        {1, 10, bench::study::Verdict::sound, bench::study::Verdict::diverged}, 30, false, three);
    EXPECT_NEAR(end.low, 2, 1e-6);
    EXPECT_EQ(end.at_high, bench::study::Verdict::adhesive);
    const auto mirrored = [&three](double x) { return three(11 - x); };
    const bench::suite::Bracket start =
        bench::suite::bisect({1, 10, bench::study::Verdict::diverged, bench::study::Verdict::sound},
                             30, false, mirrored);
    EXPECT_NEAR(start.high, 9, 1e-6);
    EXPECT_EQ(start.at_low, bench::study::Verdict::adhesive);
    const auto flagged = [](double x) {  // an open ledger between is stable
        return x < 2   ? bench::study::Verdict::diverged
               : x < 3 ? bench::study::Verdict::flagged
                       : bench::study::Verdict::sound;
    };
    const bench::suite::Bracket stable = bench::suite::bisect(
        {1, 10, bench::study::Verdict::diverged, bench::study::Verdict::sound}, 30, false, flagged);
    EXPECT_NEAR(stable.low, 2, 1e-6);
    EXPECT_EQ(stable.at_high, bench::study::Verdict::flagged);
}

// ---- Boundaries against theory

constexpr const char* limits = R"(
    [[map]]
    name = "grid"
    scene = "free_string"
    schemes = ["finite_difference_explicit", "finite_difference_theta"]
    x = { key = "rate", from = 22050, to = 88200, points = 3 }
    options = { grid = 120, over_limit = 100 }
    set = { "string.0.damping.law" = "none" }
    duration = 0.1
    reference = "none"
    theory = "grid_limit"
    refine = 9
    [[map]]
    name = "penalty"
    scene = "tanpura_c3"
    schemes = ["modal_explicit_penalty"]
    x = { key = "rate", from = 1e5, to = 1e6, points = 2 }
    set = { "string.0.barrier.0.stiffness" = 4.39e6 }
    modes = 60
    duration = 0.02
    reference = "none"
    theory = "penalty_limit"
    refine = 8
)";

bench::suite::MapRun run_of(const bench::suite::Suite& suite, const fs::path& folder = {},
                            bool resume = false, int jobs = 1) {
    static const bench::compare::Catalogue catalogue;
    return bench::suite::run_maps(suite.maps, catalogue, {"\"tests\"", folder, resume, jobs},
                                  bench::store::Listener());
}

TEST(Maps, TheBoundariesOfConditionalSchemesAreWithinOnePercentOfTheory) {
    const bench::suite::Suite suite = bench::suite::parse_suite(limits, "a.toml");
    const bench::suite::MapRun run = run_of(suite);
    ASSERT_EQ(run.boundaries.size(), 3u);
    for (const bench::suite::Boundary& b : run.boundaries) {
        EXPECT_LT(std::abs(b.relative_difference()), 0.01)
            << b.map->name << " " << b.scheme->name << " " << b.theory;
        EXPECT_EQ(b.high, bench::study::Verdict::sound);
        EXPECT_NE(b.low, bench::study::Verdict::sound);
    }
    const bench::store::Table t = bench::suite::boundaries_table(run, {});
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        EXPECT_EQ(t.text(i, "theory_holds_for").starts_with("lasting contact;"),
                  t.text(i, "map") == "penalty")
            << t.text(i, "theory_holds_for");
    EXPECT_TRUE(says(bench::suite::maps_text(run), "theory holds for lasting contact;"));
}

TEST(Maps, ASteppedReferenceIsMadeForEachRateAndAContinuousOneOnce) {
    const bench::compare::Catalogue catalogue;
    const bench::suite::Trials trials(catalogue);
    const auto at = [&](const char* rate, const std::string& reference) {
        bench::suite::Trial t =
            bench::suite::trial_of("free_string", catalogue.find("modal_two_point"), reference,
                                   {{"rate", rate}, {"modes", "10"}, {"duration", "0.002"}});
        t.settings.tap_rate = 44100;
        // points that share it share the run
        return trials.plan_of(t).points.front().reference_key;
    };
    EXPECT_NE(at("44100", "modal_spatial_newton"), at("88200", "modal_spatial_newton"));
    EXPECT_EQ(at("44100", "modal_spatial_newton"), at("44100", "modal_spatial_newton"));
    EXPECT_EQ(at("44100", "exact_contact"), at("88200", "exact_contact"));
}

TEST(Maps, AReferenceWithModesOfItsOwnIsTheSameForEveryPoint) {
    const bench::compare::Catalogue catalogue;
    bench::suite::Trials trials(catalogue);
    const auto error = [&](const char* modes, int reference_modes) {
        const bench::suite::Trial t = bench::suite::trial_of(
            "tanpura_c3_release", catalogue.find("modal_two_point"), "exact_contact",
            {{"rate", "705600"}, {"modes", modes}, {"duration", "0.005"}}, reference_modes);
        return trials(t).error;
    };
    EXPECT_LT(error("20", 0), 0.02);  // within a string of 20 modes
    EXPECT_GT(error("20", 80), 0.1);  // of 80
    EXPECT_DOUBLE_EQ(error("80", 80), error("80", 0));
}

TEST(Maps, EveryPointIsARowAndARefusalSaysWhy) {
    const bench::suite::Suite suite = bench::suite::parse_suite(R"(
        [[map]]
        name = "a"
        scene = "free_string"
        schemes = ["modal_two_point", "finite_difference_explicit"]
        x = { key = "modes", values = [10, 2000] }
        y = { key = "amplitude", values = [1, 2] }
        duration = 0.005
    )",
                                                                "a.toml");
    const bench::suite::MapRun run = run_of(suite);
    const bench::store::Table t = bench::suite::maps_table(run);
    ASSERT_EQ(t.rows.size(), 8u);
    EXPECT_EQ(t.text(0, "outcome"), "sound");
    EXPECT_EQ(t.text(0, "reference"), "exact_linear");
    EXPECT_EQ(t.text(1, "outcome"), "refused");
    EXPECT_TRUE(says(t.text(1, "detail"), "half the sample rate"));
    const bench::store::Table boundaries = bench::suite::boundaries_table(
        run, {{{"modal_two_point", bench::study::Verdict::refused}, "failures/a.toml"}});
    ASSERT_GE(boundaries.rows.size(), 2u);
    EXPECT_EQ(boundaries.text(0, "between"), "sound|refused");
    EXPECT_EQ(boundaries.text(0, "reproducer"), "failures/a.toml");
}

// ---- Stopped and taken up again

TEST(Maps, PointsThatAreKeptAreNotRunAgainAndTheTableIsTheSame) {
    const Scratch scratch;
    const bench::suite::Suite suite = bench::suite::parse_suite(limits, "a.toml");
    const bench::suite::MapRun whole = run_of(suite, scratch.path);
    EXPECT_EQ(whole.read_back, 0);
    // as if the suite had been stopped: a part of its points, and one that was cut off
    int removed = 0;
    for (const auto& entry : fs::directory_iterator(scratch.path / "points")) {
        if (++removed % 3 == 0) fs::remove(entry.path());
        if (removed % 7 == 0) std::ofstream(entry.path()) << "{";
    }
    const bench::suite::MapRun resumed = run_of(suite, scratch.path, true, 2);
    EXPECT_GT(resumed.read_back, 0);
    EXPECT_GT(resumed.ran, 0);
    EXPECT_EQ(resumed.ran + resumed.read_back, whole.ran);
    EXPECT_EQ(csv(maps_table(resumed)), csv(maps_table(whole)));
    EXPECT_EQ(csv(boundaries_table(resumed, {})), csv(boundaries_table(whole, {})));
    EXPECT_EQ(run_of(suite, scratch.path, true).ran, 0);
    const auto first = fs::directory_iterator(scratch.path / "points")->path(),
               second = std::next(fs::directory_iterator(scratch.path / "points"))->path();
    // a point under the name of another
    fs::copy_file(first, second, fs::copy_options::overwrite_existing);
    EXPECT_EQ(run_of(suite, scratch.path, true).ran, 1);
}

TEST(Maps, TheProgramWritesTablesForASuiteOfMapsAlone) {
    const Scratch scratch;
    std::ofstream(scratch / "s.toml") << R"(
        [[map]]
        name = "a"
        scene = "free_string"
        schemes = ["modal_two_point"]
        x = { key = "rate", values = [44100, 88200] }
        duration = 0.005
    )";
    const auto r = jvari(scratch, "suite " + (scratch / "s.toml") + " --out " + (scratch / "out"),
                         "JVARI_NODE_MODULES=/nowhere");
    EXPECT_EQ(r.code, 0) << r.err;
    const bench::store::Table t = bench::store::read_csv(content(scratch / "out/maps.csv"));
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_EQ(t.text(1, "outcome"), "sound");
    EXPECT_TRUE(fs::exists(scratch / "out/boundaries.csv"));
    EXPECT_FALSE(fs::exists(scratch / "out/cells.csv"));
    const auto bad = jvari(scratch, "suite " + (scratch / "none.toml"));
    EXPECT_EQ(bad.code, 2);
}

}  // namespace
}  // namespace jvari::test
