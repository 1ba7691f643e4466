// Every way in which a scheme is known to fail, from its smallest reproducer; and the minimiser
// that made them, on a toy. `jvari suite stability --out DIR` writes them to DIR/failures; copied
// to tests/failures they are what is replayed here.
#include "bench/suite/maps.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <set>

#include "scenes/scene_file.hpp"

namespace jvari::test {
namespace {

const bench::compare::Catalogue& catalogue() {
    static const bench::compare::Catalogue c;
    return c;
}

TEST(Failures, EveryReproducerFailsAsItIsSaidTo) {
    bench::study::References references;
    const auto all = bench::suite::read_failures(JVARI_FAILURES, catalogue());
    ASSERT_FALSE(all.empty());
    for (const bench::suite::Failure& f : all) {
        const bench::study::Judgement is = outcome_of(f, catalogue(), references);
        EXPECT_STREQ(name_of(is.verdict), name_of(f.expected.verdict))
            << f.file << ": " << is.detail;
        // a growth from rounding is as long as its logarithm
        EXPECT_LE(is.step, 2 * f.expected.step) << f.file;
        EXPECT_GE(2 * is.step, f.expected.step) << f.file;
    }
}

TEST(Failures, AMapThatReproducesNoneHasNone) {
    for (const bool reproduce : {true, false}) {
        const bench::suite::Suite suite = bench::suite::parse_suite(std::string(R"(
            [[cells]]
            name = "a"
            scenes = "tanpura_c3_release"
            schemes = "modal_explicit_penalty"
            modes = 10
            duration = 0.001
            measure = "outcome"
            sweep = { rate = [44100] }
            set = { "string.0.start.amplitude" = -1e-6 }
            reference = "none"
            reproduce = )") + (reproduce ? "true" : "false"),
                                                                    "a.toml");
        const bench::study::Plan plan = bench::suite::plan_of(suite.maps, catalogue(), {});
        const bench::suite::MapRun run = bench::suite::run_maps(
            "", false, suite.maps, plan, catalogue(), {}, 1, bench::store::Listener());
        ASSERT_EQ(run.points.size(), 1u);
        EXPECT_EQ(run.points[0].judgement.verdict, bench::study::Verdict::diverged);
        EXPECT_EQ(failures_of("", false, run, catalogue(), {}, 1, bench::store::Listener()).size(),
                  reproduce ? 1u : 0u);
    }
}

TEST(Failures, EveryControlHasOne) {
    std::set<std::string> failing;
    for (const bench::suite::Failure& f : bench::suite::read_failures(JVARI_FAILURES, catalogue()))
        failing.insert(f.scheme->name);
    for (const char* control :
         {"modal_explicit_penalty", "modal_two_point_trapezoidal", "modal_quadratised",
          "finite_difference_explicit", "finite_difference_theta", "modal_spatial_newton"})
        EXPECT_TRUE(failing.contains(control)) << control;
}

bench::suite::Failure large() {
    bench::suite::Failure t{"a.toml",
                            &catalogue().find("modal_two_point"),
                            read_scene("tanpura_c3_release"),
                            {},
                            "none"};
    t.settings.sample_rate = t.settings.tap_rate = 44100;
    t.scene.duration = 0.1;
    return t;
}

TEST(Failures, EveryOutcomeHasOne) {
    std::set<bench::study::Verdict> seen;
    bool gains = false;
    for (const bench::suite::Failure& f :
         bench::suite::read_failures(JVARI_FAILURES, catalogue())) {
        seen.insert(f.expected.verdict);
        gains = gains || (f.scheme->name == std::string("modal_explicit_penalty") &&
                          f.expected.verdict == bench::study::Verdict::energy_gaining);
    }
    for (const bench::study::Verdict v :
         {bench::study::Verdict::inaccurate, bench::study::Verdict::adhesive,
          bench::study::Verdict::energy_gaining, bench::study::Verdict::not_converged,
          bench::study::Verdict::diverged})
        EXPECT_TRUE(seen.contains(v)) << name_of(v);
    EXPECT_TRUE(gains);  // where modal_two_point is sound; its inaccurate points are everyone's
}

TEST(Minimiser, TakesAwayAllThatAFailureDoesNotNeed) {
    const bench::suite::Failure t =
        // fails with a thread, from 17 modes and 23 rows on
        bench::suite::minimised(large(), [](const bench::suite::Failure& x) {
            return x.scene.strings[0].thread && x.settings.modes >= 17 &&
                   x.scene.duration * x.settings.tap_rate > 22.5;
        });
    EXPECT_EQ(t.settings.modes, 17);
    EXPECT_EQ(std::lround(t.scene.duration * t.settings.tap_rate), 23);
    const String& s = t.scene.strings[0];
    EXPECT_TRUE(s.thread);
    EXPECT_TRUE(s.barriers.empty());
    EXPECT_EQ(s.bending_stiffness, 0);
    EXPECT_TRUE(std::holds_alternative<NoDamping>(s.damping));
    EXPECT_EQ(t.scene.taps.size(), 1u);
}

TEST(Minimiser, KeepsWhatIsNeededTogetherAndWhatThrows) {
    const bench::suite::Failure t =
        bench::suite::minimised(large(), [](const bench::suite::Failure& x) {
            if (x.scene.strings[0].barriers.empty()) throw std::runtime_error("nothing to fail at");
            // either will do
            return x.scene.strings[0].thread.has_value() ||
                   x.scene.strings[0].bending_stiffness > 0;
        });
    const String& s = t.scene.strings[0];
    EXPECT_EQ(s.barriers.size(), 1u);
    EXPECT_NE(s.thread.has_value(), s.bending_stiffness > 0);
    EXPECT_EQ(t.settings.modes, 1);
}

TEST(Minimiser, WhatItWritesReadsBackAsTheSameFailure) {
    bench::study::References references;
    bench::suite::Failure t = large();
    t.scheme = &catalogue().find("modal_explicit_penalty");
    const auto diverges = [&references](const bench::suite::Failure& x) {
        return outcome_of(x, catalogue(), references).verdict == bench::study::Verdict::diverged;
    };
    ASSERT_TRUE(diverges(t));
    t = bench::suite::minimised(t, diverges);
    EXPECT_LT(t.settings.modes, 133);
    const auto folder =
        std::filesystem::temp_directory_path() / ("jvari-failures-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    t.expected = outcome_of(t, catalogue(), references);
    bench::suite::write_failures(folder, {t});
    const auto back = bench::suite::read_failures(folder, catalogue());
    std::filesystem::remove_all(folder);
    ASSERT_EQ(back.size(), 1u);
    EXPECT_EQ(plan_of(back[0], catalogue(), "{}").jobs[0].identity,
              plan_of(t, catalogue(), "{}").jobs[0].identity);
    EXPECT_EQ(back[0].expected.verdict, bench::study::Verdict::diverged);
}

}  // namespace
}  // namespace jvari::test
