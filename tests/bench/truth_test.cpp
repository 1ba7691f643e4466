// How far a reference is doubled, whatever the unit, and what it is known to where a number of
// points is asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <regex>

#include "bench/compare/bound.hpp"
#include "bench/compare/compare.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/study/reference_size.hpp"
#include "bench/study/truth.hpp"
#include "reference/agreement.hpp"
#include "reference/profile_points.hpp"
#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "tests/says.hpp"

namespace jvari {
namespace {

using bench::study::ReferenceChoice, bench::study::Truth;

Truth truth_of(const Scene& scene, double tap_rate, int modes, int begin, OptionValues options) {
    const ReferenceChoice c{&exact_contact, {0, tap_rate, 0, std::move(options)}, ""};
    return bench::study::run_truth({c}, scene, modes, 1, bench::store::Listener(), HUGE_VAL, begin);
}

// ---- Units

// Bar of 70 mm over a stop, or the same with lengths and times `unit` times as large.
Scene bar(double unit) {
    Scene scene;
    scene.name = "bar";
    scene.duration = 9e-3 * unit;
    String& s = scene.strings.emplace_back();
    s.length = 0.07 * unit;
    s.linear_density = 0.1;
    s.tension = 1e-3;
    s.bending_stiffness = unit * unit;
    s.damping = PolynomialDamping{2 / unit, 0, 1e-5 * unit * unit};
    s.barriers = {LumpedBarrier{0.023 * unit, 0, -1e-6 * unit, {1e6 / unit}, 1, 0}};
    s.start = TriangleShape{0.042 * unit, 3e-5 * unit, 7e-3 * unit};
    scene.taps = {{"y", Quantity::displacement, 0, 0.019 * unit},
                  {"stop", Quantity::bridge_force, 0, 0}};
    return scene;
}

TEST(Truth, IsAffordableWhateverTheUnitOfLengthAndTime) {
    Scene large = bar(1), small = bar(1e-3);
    for (Scene* scene : {&large, &small}) {  // work that grows with modes^2, and is too much
        scene->duration *= 100;
        scene->strings[0].tension = 1, scene->strings[0].bending_stiffness = 0;
    }
    int affordable = 0;
    for (int modes = 64; modes <= 4096; modes *= 2) {
        const bench::study::Size size{modes, 0};
        const bool can = bench::study::within_budget(exact_contact, large, 32e3, size);
        EXPECT_EQ(can, bench::study::within_budget(exact_contact, small, 32e6, size)) << modes;
        affordable += can;
    }
    EXPECT_TRUE(affordable > 0 && affordable < 7) << affordable;
}

// At 44.1 rows in a second none holds a mode, and the reference still moves those below 20 kHz.
TEST(Truth, IsNoMoreAffordableWhereThereAreFewerRows) {
    Scene ideal = bench::compare::load_scene("tanpura_c3_release", {}, 0.2);
    ideal.strings[0].bending_stiffness = 0;
    const auto allows = [](const Scene& scene, double tap_rate, bench::study::Size size) {
        return bench::study::within_budget(exact_contact, scene, tap_rate, size);
    };
    int most = 8;
    while (allows(ideal, 44100, {most + 8, 0})) most += 8;
    EXPECT_TRUE(allows(ideal, 44.1, {most * 9 / 10, 0})) << most;
    EXPECT_FALSE(allows(ideal, 44.1, {most * 11 / 10, 0})) << most;
    const Scene profile = bench::compare::load_scene("sitar_parabola", {}, 0.2);
    for (const double tap_rate : {44100.0, 44.1}) {
        EXPECT_TRUE(allows(profile, tap_rate, {40, 32})) << tap_rate;
        EXPECT_FALSE(allows(profile, tap_rate, {40, 64})) << tap_rate;
    }
}

TEST(Truth, IsTheSameWhateverTheUnitOfLengthAndTime) {
    for (const int begin : {0, 12}) {
        const Truth large = truth_of(bar(1), 32e3, 0, begin, {}),
                    small = truth_of(bar(1e-3), 32e6, 0, begin, {});
        ASSERT_EQ(small.reference.choice.settings.modes, large.reference.choice.settings.modes);
        EXPECT_EQ(modes_below(bar(1e-3).strings[0], 20e3), 0)
            << "the other one has no unit of 20 kHz";
        ASSERT_EQ(small.coarser.size(), large.coarser.size());
        ASSERT_GE(large.coarser.size(), 1u);
        for (std::size_t tap = 0; tap < 2; ++tap) {
            const double known = large.reference.trust.of_scene(tap, 2);
            EXPECT_GT(known, 0);
            EXPECT_NEAR(small.reference.trust.of_scene(tap, 2), known, 1e-3 * known) << tap;
        }
    }
}

TEST(Truth, BeginsWithTheModesOfTheCellsAndNoneThatTheRowsDoNotHold) {
    const String c3 = read_scene("tanpura_c3_release").strings[0];
    Scene scene;
    scene.strings = {c3};
    using bench::study::modes_to_begin_with;
    EXPECT_EQ(modes_to_begin_with(scene, 44100, 0), modes_below(c3, 20e3));
    EXPECT_EQ(modes_to_begin_with(scene, 705600, 0), modes_below(c3, 20e3));
    EXPECT_EQ(modes_to_begin_with(scene, 705600, 300), 300);
    EXPECT_EQ(modes_to_begin_with(scene, 44100, 40), 40);
    EXPECT_EQ(modes_to_begin_with(scene, 44100, 300), modes_below(c3, 20e3));
    EXPECT_EQ(modes_to_begin_with(scene, 4410, 0), modes_below(c3, 2e3));
    EXPECT_EQ(modes_to_begin_with(scene, 44.1, 0), modes_below(c3, 20e3));
    EXPECT_EQ(modes_to_begin_with(bar(1e-3), 64e6, 0),
              modes_below(bar(1).strings[0], 64e3 * 20 / 44.1));
}

// Windows between contacts are most of a run's work, whatever the law and the number of barriers.
TEST(Truth, HasTheBudgetForALumpedContactOfAnyLawThatItHasForASpring) {
    Scene spring = read_scene("tanpura_c3_release"), power = spring, lossy = spring, three = spring;
    auto& b = std::get<LumpedBarrier>(power.strings[0].barriers[0]);
    b.exponent = 1.5;
    std::get<LumpedBarrier>(lossy.strings[0].barriers[0]).contact_loss = 0.5;
    for (const double x : {0.1, 0.2})
        three.strings[0].barriers.push_back(LumpedBarrier{x, 0, -1e-4, {1e8}, 1, 0});
    const auto allows = [](const Scene& scene, int modes, double effort) {
        return bench::study::within_budget(exact_contact, scene, 44100, {modes, 0}, effort);
    };
    int most = 100;
    while (allows(spring, most + 1, 0.1)) ++most;
    for (const Scene& scene : {power, lossy, three}) {
        EXPECT_TRUE(allows(scene, most, 0.2));
        EXPECT_FALSE(allows(scene, most, 0.1));
    }
}

TEST(Plan, WhereNoModeLiesBelow20KHzTheLowestRateSaysHowManyAllCarry) {
    bench::compare::CompareRequest r;
    r.schemes = {"modal_two_point"};
    r.rates = {64e6, 256e6};
    r.tap_rate = 64e6;
    r.search = false;
    bench::study::Plan plan;
    bench::study::Point common;
    common.scene = bar(1e-3);
    bench::compare::add_jobs(plan, r, bench::compare::Catalogue(), common, {});
    ASSERT_FALSE(plan.jobs.empty());
    for (const bench::study::Job& job : plan.jobs) EXPECT_EQ(job.cell.settings.modes, 5);
    EXPECT_STREQ(plan.points.front().references.front().scheme->name, "exact_contact");
}

// ---- Remedies

// A table of the parabola's lowest modes.
Scene measured(Scene scene) {
    String& s = scene.strings.front();
    const Modes modes = modes_of(s, 30);
    TableDamping table;
    for (int i = 0; i < modes.count(); ++i) {
        table.frequency_hz.push_back(modes.omega0[i] / (2 * std::numbers::pi));
        table.decay_rate.push_back(modes.sigma[i]);
    }
    s.damping = table;
    return scene;
}

int points_in(const std::string& hint) {
    std::smatch found;
    return std::regex_search(hint, found, std::regex("nodes=([0-9]+) takes more"))
               ? std::stoi(found[1])
               : 0;
}

// Points that are asked for leave something out as points do that are not.
TEST(Truth, IsKnownToNoLessThanTheRemedyThatItPrintsChanges) {
    const Scene parabola = bench::compare::load_scene("sitar_parabola", {}, 4e-3);
    for (const Scene& scene : {parabola, measured(parabola)}) {
        std::vector<Truth> followed;
        for (int points = 8; points > 0 && points <= 32;
             points = points_in(followed.back().description))
            followed.push_back(truth_of(scene, 44100, 0, 20, {{"nodes", std::to_string(points)}}));
        ASSERT_EQ(followed.size(), 3u) << followed.back().description;
        const Trace& last = followed.back().reference.run.trace;
        for (const Truth& t : followed) {
            EXPECT_TRUE(says(t.reference.trust.doubled, "points"));
            for (std::size_t tap = 0; tap < scene.taps.size(); ++tap) {
                const double known = t.reference.trust.of_scene(tap, 2),
                             changed = bench::study::change(last, t.reference.run.trace,
                                                            static_cast<int>(tap), 0, 2);
                EXPECT_FALSE(known < changed) << scene.taps[tap].name << ", " << t.description;
            }
        }
    }
}

// `--modes N` and compliance=matched of a comparison without a cell within 1 %: with either the
// error falls, by more than the uncertainty of the reference.
TEST(Cheapest, ModesAndCompliancesThatAreToBeTriedBringTheErrorDown) {
    using namespace bench::compare;
    const Catalogue catalogue;
    struct Least {
        double error = HUGE_VAL, certificate = 0;
        int to_try = 0;
        std::string why;
    };
    const auto least = [&](int modes, const char* compliance) {
        CompareRequest r;
        r.scene = "tanpura_c3_release";
        r.schemes = {"modal_two_point"};
        r.rates = {88200, 176400};
        r.modes = {modes};
        r.options = {{"", "compliance", compliance}};
        r.duration = 0.05;
        r.reference_modes = 320;
        r.repeats = 1;
        r.search = false;
        const bench::study::Cells cells = cells_of(compare(r, catalogue, bench::store::Listener()));
        Least found;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const Bound b = bound_of(cells[i], bench::study::measure("error_l2_50ms"));
            if (b.error < found.error) found.error = b.error, found.certificate = b.certificate;
        }
        std::smatch hint;
        for (const Answer& a : cheapest_of(cells))
            if (std::string(a.status) == "none" && a.most == 0.01 &&
                std::regex_search(a.why, hint, std::regex("try `--modes ([0-9]+)`")))
                found.to_try = std::stoi(hint[1]), found.why = a.why;
        return found;
    };
    const Least few = least(30, "own");
    ASSERT_EQ(few.to_try, 60);
    ASSERT_TRUE(says(few.why, "compliance=matched was not run."));
    for (const Least& followed : {least(few.to_try, "own"), least(30, "matched")})
        EXPECT_LT(followed.error + followed.certificate, few.error - few.certificate);
}

// `--reference-modes N`, `smoothing` of a sharp corner, a shorter `--duration`: what each leads to
// is known to no less than four times the modes, and twice the points, change it by.
TEST(Truth, IsKnownToNoLessThanFourTimesTheModesChangeWhateverRemedyIsFollowed) {
    const auto c3 = [](double duration, double smoothing) {
        Scene scene = bench::compare::load_scene("tanpura_c3_release", {}, duration);
        scene.strings.front().start = TriangleShape{0.4, 1e-3, smoothing};
        return scene;
    };
    struct Remedy {
        const char* text;
        Scene scene;
        int modes;
        int points = 0;
    };
    for (const Remedy& r : {Remedy{"--reference-modes 40", c3(5e-3, 0.1), 40},
                            {"--reference-modes 80", c3(5e-3, 0.1), 80},
                            {"smoothing", c3(5e-3, 0.02), 80},
                            {"none, a sharp corner", c3(5e-3, 0), 80},
                            {"a shorter --duration", c3(2e-3, 0.1), 40},
                            {"a shorter --duration of a profile",
                             bench::compare::load_scene("sitar_parabola", {}, 2e-3), 40, 16}}) {
        const Truth t = truth_of(r.scene, 44100, r.modes, 0, {});
        OptionValues options = matched(exact_contact, r.scene, {}).value_or(OptionValues{});
        if (r.points > 0) options.emplace_back("nodes", std::to_string(2 * r.points));
        const Trace finer = run(exact_contact, r.scene, {0, 44100, 4 * r.modes, options}).trace;
        int known_taps = 0;
        for (std::size_t tap = 0; tap < r.scene.taps.size(); ++tap) {
            const double known = t.reference.trust.of_scene(tap, 2),
                         changed = bench::study::change(finer, t.reference.run.trace,
                                                        static_cast<int>(tap), 0, 2);
            known_taps += std::isfinite(known);
            EXPECT_FALSE(known < changed) << r.text << ": " << r.scene.taps[tap].name;
        }
        EXPECT_GT(known_taps, 0) << r.text;
    }
}

// N own modes leave out about sin(N pi x/L)/N of the nut force of a blow at x, so two numbers of
// modes may agree by chance. At 0.94 m half of 1552 modes change it by 0.9e-3, and it errs by 2e-3.
TEST(Truth, OfABlowIsKnownToNoLessThanItErrs) {
    Scene scene = bench::compare::load_scene("free_string", {}, 0.01);
    String& s = scene.strings.front();
    s.start.reset();
    Mass& hammer = s.masses.emplace_back();
    hammer.mass = 3e-3, hammer.velocity = 2, hammer.gap = 1e-4, hammer.stiffness = 1e5;
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}};
    for (const double x : {0.16, 0.52, 0.94}) {
        hammer.position = x;
        const Truth own = truth_of(scene, 44100, 1552, 0, {{"compliance", "own"}}),
                    unasked = truth_of(scene, 44100, 388, 0, {});
        ASSERT_TRUE(is_matched(unasked.reference.choice.settings.options));
        const Trace finer =
            run(exact_contact, scene, {0, 44100, 1552, {{"compliance", "matched"}}}).trace;
        for (const Truth* truth : {&own, &unasked}) {
            const double known = truth->reference.trust.of_scene(0, 2),
                         error = bench::study::change(finer, truth->reference.run.trace, 0, 0, 2);
            EXPECT_FALSE(known < error) << x << " m: " << error << " of " << known << " claimed";
        }
    }
}

TEST(Truth, OfAGivenNumberOfModesLeavesOutWhatThePointsDoToo) {
    const Truth t =
        truth_of(bench::compare::load_scene("sitar_parabola", {}, 2e-3), 44100, 40, 0, {});
    EXPECT_EQ(t.reference.trust.doubled, "modes and points");
    std::vector<std::pair<int, int>> sizes;
    for (const auto& r : t.coarser)
        sizes.emplace_back(r.choice.settings.modes, profile_points(r.choice.settings).count);
    EXPECT_EQ(sizes,
              (std::vector<std::pair<int, int>>{{10, 8}, {20, 8}, {20, 16}, {40, 16}, {20, 32}}));
    EXPECT_EQ(t.reference.choice.settings.options, OptionValues());
}

// Runs whose only row is 1 + error(modes, points), the reference last.
Truth of_sizes(const std::vector<std::pair<int, int>>& sizes,
               const std::function<double(double, double)>& error) {
    Truth t;
    t.has_points = true;
    for (const auto& [modes, points] : sizes) {
        bench::study::Reference r{};
        r.choice.settings.modes = modes;
        r.choice.settings.options = {{"nodes", std::to_string(points)}};
        r.run.trace.tap = {1 + error(modes, points)};
        t.coarser.push_back(r);
    }
    t.reference = t.coarser.back();
    t.coarser.pop_back();
    return t;
}

// More points let more modes in: half the modes change a profile of 32 points by four times what
// they change one of 8 points by.
TEST(Truth, OfAProfileLeavesOutWhatModesAndPointsDoEachWithAllOfTheOther) {
    const auto error = [](double modes, double points) {
        return 1e-4 * points / modes + 1e-2 / points;
    };
    const auto known = [&](const std::vector<std::pair<int, int>>& sizes) {
        return bench::study::left_out(of_sizes(sizes, error), [](const Trace& a, const Trace& b) {
            return std::abs(a.tap[0] - b.tap[0]);
        });
    };
    EXPECT_NEAR(known({{20, 8}, {40, 8}, {40, 16}, {20, 32}, {40, 32}}),
                2.5 * 32e-4 / 40 + 1e-2 / 32 + 8e-4 / 40, 1e-12);
    // what modes do with fewer points tells nothing, nor does one doubling of both
    EXPECT_TRUE(std::isnan(known({{20, 8}, {40, 8}, {40, 16}, {40, 32}})));
    EXPECT_TRUE(std::isnan(known({{20, 8}, {40, 16}})));
}

}  // namespace
}  // namespace jvari
