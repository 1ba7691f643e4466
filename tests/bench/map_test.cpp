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

TEST(MapFile, SweptKeysAreListedOrSpacedByEqualRatiosInTheOrderOfTheFile) {
    const bench::suite::Suite s = bench::suite::parse_suite(R"(
        [[cells]]
        name = "a"
        scenes = "free_string"
        measure = "outcome"
    sweep = { rate = { from = 1, to = 1e6, points = 7 }, modes = { from = 9, to = 36, points = 3 } }
        duration = 0.5
        options = { grid = 100 }
        set = { "string.0.damping.law" = "none" }
    )",
                                                            "a.toml");
    EXPECT_TRUE(s.sets.empty());
    ASSERT_EQ(s.maps.size(), 1u);
    const auto &x = s.maps[0].sweep[0], &y = s.maps[0].sweep[1];
    EXPECT_EQ(x.key, "rate");
    EXPECT_EQ(x.at, (std::vector<double>{1, 10, 100, 1e3, 1e4, 1e5, 1e6}));
    EXPECT_FALSE(x.whole);
    EXPECT_EQ(y.values, (std::vector<std::string>{"9", "18", "36"}));
    EXPECT_TRUE(y.whole);
    EXPECT_TRUE(s.maps[0].reproduce);
    const std::vector<bench::suite::SuitePoint> points = bench::suite::points_of(s.maps);
    ASSERT_EQ(points.size(), 21u);
    const auto& second = points[1];  // x varies first
    EXPECT_EQ(second.swept,
              (std::vector<std::pair<std::string, std::string>>{{"rate", "10"}, {"modes", "9"}}));
    EXPECT_EQ(second.request.rates, std::vector<double>{10});
    EXPECT_EQ(second.request.modes, std::vector<int>{9});
    EXPECT_EQ(second.request.duration, 0.5);
    EXPECT_EQ(second.request.options.at(0).value, "100");
    EXPECT_EQ(second.request.set, std::vector<std::string>{"string.0.damping.law=\"none\""});
}

TEST(MapFile, WhatItDoesNotKnowIsAnErrorWithFileLineAndKey) {
    const std::string head = "[[cells]]\nname = \"a\"\nscenes = \"b\"\nmeasure = \"outcome\"\n",
                      x = "sweep = { rate = [1, 2] }\n";
    const std::pair<std::string, const char*> cases[] = {
        {"[[cells]]\nscenes = \"b\"\nmeasure = \"outcome\"\n" + x,
         "a.toml:1: cells.0: the key name is missing"},
        {head, "a.toml:1: cells.0: the key sweep is missing"},
        {head + "sweep = { rate = { form = 1 } }",
         "a.toml:5: cells.0.sweep.rate: unknown key \"form\"; did you mean \"from\"?"},
        {head + "sweep = { rate = { to = 1, points = 3 } }",
         "a.toml:5: cells.0.sweep.rate: the key from is missing"},
        {head + "sweep = { rate = { from = 2, to = 1, points = 3 } }",
         "cells.0.sweep.rate.to: found 1, expected more than from"},
        {head + "sweep = { rate = { from = 1, to = 2, points = 1 } }",
         "cells.0.sweep.rate.points: found 1, expected a whole number from 2 to 1000000"},
        {head + "sweep = { rate = [2, 1] }",
         "a.toml:5: cells.0.sweep.rate: expected numbers that ascend"},
        {head + "sweep = { rate = [-2] }",
         "a.toml:5: cells.0.sweep.rate.0: found -2, expected a number > 0"},
        {head + "sweep = { modes = [2.5] }",
         "a.toml:5: cells.0.sweep.modes.0: found 2.5, expected a whole number from 1 to 9999999"},
        {head + "sweep = { a = [1], b = [2], c = [3] }", "expected one or two keys on a map"},
        {head + x + "rates = 3",
         "cells.0.sweep.rate: expected a key that is not set for all points as well"},
        {head + "sweep = { k = [1] }\nset = { k = 1 }",
         "cells.0.sweep.k: expected a key that is not set for all points as well"},
        {head + "sweep = { \"option:grid\" = [9] }\noptions = { grid = 8 }",
         "cells.0.sweep.option:grid: expected a key that is not set for all points as well"},
        {head + x + "modes = [1, 2]", "cells.0.modes: found an array, expected one value on a map"},
        {head + x + "options = { grid = [8, 9] }",
         "cells.0.options: expected one value of each on a map"},
        {head + x + "tap_rate = 1", "a.toml:6: cells.0.tap_rate: expected no such key on a map"},
        {head + x + "reproduce = 1",
         "a.toml:6: cells.0.reproduce: found 1, expected true or false"},
        {head + x + "theory = \"grid\"", "a.toml:6: cells.0.theory: unknown theory \"grid\""},
        {head + "sweep = { \"string.0.damping.law\" = [\"none\"] }\nrefine = 3",
         "cells.0.refine: expected numbers as the first swept key"},
        {head + x + head + x, "cells.1.name: found \"a\", expected a name of its own"},
        {"[[cells]]\nscenes = \"b\"\nrefine = 3",
         "cells.0.refine: expected measure = \"outcome\" beside it"},
        {"[[cells]]\nname = \"A b\"\nscenes = \"b\"\n" + x, "a.toml:2: cells.0.name"},
        {"[[cells]]\nname = \"a\"\nscenes = \"b\"\nmeasure = [\"errors\", \"outcome\"]\n" + x,
         "cells.0.measure: expected outcome alone"},
    };
    for (const auto& [text, expected] : cases) EXPECT_TRUE(says(refusal_of(text), expected));
}

TEST(MapFile, MorePointsThanCanBeRunAreRefusedWithTheirNumber) {
    const auto map = [](const std::string& x, const std::string& y) {
        const std::string range = " = { from = 1, to = 2, points = ";
        return refusal_of(
            "[[cells]]\nname = \"a\"\nscenes = \"free_string\"\nmeasure = \"outcome\"\nschemes = "
            "[\"modal_two_point\", \"modal_quadratised\"]\nsweep = { rate" +
            range + x + " }, duration" + range + y + " } }\n");
    };
    EXPECT_EQ(map("9999999", "2"),
              "a.toml:6: cells.0.sweep.rate.points: found 9999999, expected a whole number from 2 "
              "to 1000000");
    EXPECT_EQ(map("10000", "1000"),
              "a.toml:1: cells.0: found 20000000 cells, expected at most 1000000: each is a run");
    EXPECT_EQ(map("500", "1000"), "read");
}

// ---- Bisection

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
    [[cells]]
    name = "grid"
    scenes = "free_string"
    schemes = ["finite_difference_explicit", "finite_difference_theta"]
    measure = "outcome"
    sweep = { rate = { from = 22050, to = 88200, points = 3 } }
    options = { grid = 120, over_limit = 100 }
    set = { "string.0.damping.law" = "none" }
    duration = 0.1
    reference = "none"
    theory = "grid_limit"
    refine = 9
    [[cells]]
    name = "penalty"
    scenes = "tanpura_c3"
    schemes = ["modal_explicit_penalty"]
    measure = "outcome"
    sweep = { rate = { from = 1e5, to = 1e6, points = 2 } }
    set = { "string.0.barrier.0.stiffness" = 4.39e6 }
    modes = 60
    duration = 0.02
    reference = "none"
    theory = "penalty_limit"
    refine = 8
)";

const bench::compare::Catalogue& map_schemes() {
    static const bench::compare::Catalogue all;
    return all;
}

fs::path existing(const fs::path& folder) {
    if (!folder.empty()) fs::create_directories(folder);
    return folder;
}

struct Mapped {  // maps of a suite that outlives this
    bench::study::Plan plan;
    bench::suite::MapRun run;
    explicit Mapped(const bench::suite::Suite& suite, const fs::path& folder = {},
                    bool resume = false, int jobs = 1)
        : plan(bench::suite::plan_of(suite.maps, map_schemes(), {})),
          run(bench::suite::run_maps(existing(folder), resume, suite.maps, plan, map_schemes(), {},
                                     jobs, bench::store::Listener())) {}
};

TEST(Maps, TheBoundariesOfConditionalSchemesAreWithinOnePercentOfTheory) {
    const bench::suite::Suite suite = bench::suite::parse_suite(limits, "a.toml");
    const Mapped mapped(suite);
    const bench::suite::MapRun& run = mapped.run;
    ASSERT_EQ(run.boundaries.size(), 3u);
    for (const bench::suite::Boundary& b : run.boundaries) {
        EXPECT_LT(std::abs(b.relative_difference()), 0.01)
            << bench::study::what_of(*b.below->job) << " " << b.theory;
        EXPECT_EQ(b.between.at_high, bench::study::Verdict::sound);
        EXPECT_NE(b.between.at_low, bench::study::Verdict::sound);
    }
    const bench::store::Table t = bench::suite::boundaries_table(run, {});
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        EXPECT_EQ(t.text(i, "theory_holds_for").starts_with("lasting contact;"),
                  t.text(i, "map") == "penalty")
            << t.text(i, "theory_holds_for");
    EXPECT_TRUE(says(bench::suite::maps_text(run), "theory holds for lasting contact;"));
}

TEST(Maps, ASteppedReferenceIsMadeForEachRateAndAContinuousOneOnce) {
    const auto at = [](double rate, const std::string& reference) {
        bench::study::Plan plan;
        Scene scene = read_scene("free_string");
        scene.duration = 0.002;
        plan.points.push_back(
            bench::suite::judged_point(map_schemes(), scene, {rate, 44100, 10, {}}, reference, 0));
        plan.jobs.push_back(bench::suite::judged_job(map_schemes().find("modal_two_point"),
                                                     plan.points.front(), {rate, 44100, 10, {}}));
        bench::study::address(plan, "{}");
        // points that share it share the run
        return plan.points.front().reference_key;
    };
    EXPECT_NE(at(44100, "modal_spatial_newton"), at(88200, "modal_spatial_newton"));
    EXPECT_EQ(at(44100, "modal_spatial_newton"), at(44100, "modal_spatial_newton"));
    EXPECT_EQ(at(44100, "exact_contact"), at(88200, "exact_contact"));
}

TEST(Maps, AReferenceWithModesOfItsOwnIsTheSameForEveryPoint) {
    const auto error = [](int modes, const std::string& reference_modes) {
        const bench::suite::Suite suite = bench::suite::parse_suite(
            "[[cells]]\nname = \"a\"\nscenes = \"tanpura_c3_release\"\nschemes = "
            "\"modal_two_point\"\nreference = \"exact_contact\"\nrates = 705600\nduration = "
            "0.005\nmeasure = \"outcome\"\nreference_modes = " +
                reference_modes + "\nsweep = { modes = [" + std::to_string(modes) + "] }",
            "a.toml");
        return Mapped(suite).run.points.at(0).error;
    };
    EXPECT_LT(error(20, "\"cell\""), 0.02);  // within a string of 20 modes
    EXPECT_GT(error(20, "80"), 0.1);         // of 80
    EXPECT_DOUBLE_EQ(error(80, "80"), error(80, "\"cell\""));
}

TEST(Maps, EveryPointIsARowAndARefusalSaysWhy) {
    const bench::suite::Suite suite = bench::suite::parse_suite(R"(
        [[cells]]
        name = "a"
        scenes = "free_string"
        schemes = ["modal_two_point", "finite_difference_explicit"]
        measure = "outcome"
        sweep = { modes = [10, 2000], amplitude = [1, 2] }
        duration = 0.005
    )",
                                                                "a.toml");
    const Mapped mapped(suite);
    const bench::suite::MapRun& run = mapped.run;
    const bench::store::Table t = bench::suite::maps_table(run);
    ASSERT_EQ(t.rows.size(), 8u);
    EXPECT_NE(mapped.plan.points[0].hash, mapped.plan.points[2].hash);  // twice the amplitude
    EXPECT_EQ(mapped.plan.points[0].hash, mapped.plan.points[1].hash);
    EXPECT_EQ(t.text(0, "outcome"), "sound");
    EXPECT_EQ(t.text(0, "reference"), "exact_linear");
    EXPECT_EQ(t.text(1, "outcome"), "refused");
    EXPECT_TRUE(says(t.text(1, "detail"), "half the sample rate"));
    const bench::suite::Failure refused{
        "a.toml", &map_schemes().find("modal_two_point"), {}, {}, "",
        0,        {bench::study::Verdict::refused, "", 0}};
    const bench::store::Table boundaries = bench::suite::boundaries_table(run, {refused});
    ASSERT_GE(boundaries.rows.size(), 2u);
    EXPECT_EQ(boundaries.text(0, "between"), "sound|refused");
    EXPECT_EQ(boundaries.text(0, "reproducer"), "failures/a.toml");
}

// ---- Stopped and taken up again

TEST(Maps, PointsThatAreKeptAreNotRunAgainAndTheTableIsTheSame) {
    const Scratch scratch;
    const bench::suite::Suite suite = bench::suite::parse_suite(limits, "a.toml");
    const Mapped whole(suite, scratch / "cells");
    EXPECT_EQ(whole.run.read_back, 0);
    // as if the suite had been stopped: a part of its points, and one that was cut off
    int removed = 0;
    for (const auto& entry : fs::directory_iterator(scratch.path / "cells")) {
        if (++removed % 3 == 0) fs::remove(entry.path());
        if (removed % 7 == 0) std::ofstream(entry.path()) << "{";
    }
    const Mapped resumed(suite, scratch / "cells", true, 2);
    EXPECT_GT(resumed.run.read_back, 0);
    EXPECT_GT(resumed.run.ran, 0);
    EXPECT_EQ(resumed.run.ran + resumed.run.read_back, whole.run.ran);
    EXPECT_EQ(csv(maps_table(resumed.run)), csv(maps_table(whole.run)));
    EXPECT_EQ(csv(boundaries_table(resumed.run, {})), csv(boundaries_table(whole.run, {})));
    EXPECT_EQ(Mapped(suite, scratch / "cells", true).run.ran, 0);
    const auto first = fs::directory_iterator(scratch.path / "cells")->path(),
               second = std::next(fs::directory_iterator(scratch.path / "cells"))->path();
    // a point under the name of another
    fs::copy_file(first, second, fs::copy_options::overwrite_existing);
    EXPECT_EQ(Mapped(suite, scratch / "cells", true).run.ran, 1);
}

TEST(Maps, TheProgramWritesTablesForASuiteOfMapsAlone) {
    const Scratch scratch;
    std::ofstream(scratch / "s.toml") << R"(
        [[cells]]
        name = "a"
        scenes = "free_string"
        schemes = ["modal_two_point"]
        measure = "outcome"
        sweep = { rate = [44100, 88200] }
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
