// The error of what is heard: run and reference move with all their modes and are read by those
// below 20 kHz.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bench/compare/advice.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/job.hpp"
#include "bench/study/truth.hpp"
#include "bench/trim/judge.hpp"
#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

namespace study = bench::study;
const bench::store::Listener silent;
const std::size_t heard = study::measure("error_l2_heard"), whole = study::measure("error_l2_50ms");

Scene c3(double duration) { return lasting(read_scene("tanpura_c3_release"), duration); }

jvari::Run run_reference(const Descriptor& d, const Scene& scene, int modes,
                         OptionValues options = {}) {
    return study::run_heard(d, scene, {0, 44100, modes, std::move(options)}, {});
}

TEST(Heard, IsTheReferencesModesBelowTwentyKilohertzToTheLastBit) {
    Scene scene = lasting(read_scene("free_string"), 5e-3);
    const int below = modes_below(scene.strings[0], 20e3);
    for (const int number : {1, below, below + 1}) {
        scene.strings[0].start = ModeShape{number, 1e-3};
        const Trace t = run_reference(exact_linear, scene, below + 10).trace;
        ASSERT_EQ(t.taps(), static_cast<int>(scene.taps.size()));
        for (int k = 0; k < t.taps(); ++k)
            for (std::size_t n = 1; n < t.column(k).size(); ++n)
                ASSERT_EQ(t.heard(k)[n], number <= below ? t.column(k)[n] : 0) << number;
    }
}

// A string with the modes below 20 kHz alone moves otherwise after the first contact.
TEST(Heard, IsOfAStringWhoseOtherModesMoveToo) {
    const Scene scene = c3(20e-3);
    const int below = modes_below(scene.strings[0], 20e3);
    const Trace all = run_reference(exact_contact, scene, 4 * below).trace,
                few = run_reference(exact_contact, scene, below).trace;
    const auto apart = [](std::span<const double> a, std::span<const double> b) {
        return relative_difference(a, b);
    };
    EXPECT_EQ(apart(few.heard(0), few.column(0)), 0);
    EXPECT_GT(apart(few.column(0), all.heard(0)), 1e-2);  // the other string
    EXPECT_GT(apart(all.heard(0), all.column(0)), 1e-3);  // what is not heard
    EXPECT_EQ(apart(all.heard(2), all.column(2)), 0);     // a contact force has no modes
}

// Matched compliance adds to a tap what its string lacks below 20 kHz, and nothing that is above.
TEST(Heard, HasItsShareOfWhatMatchedComplianceAdds) {
    const Scene scene = c3(20e-3);
    const int below = modes_below(scene.strings[0], 20e3);
    const OptionValues matched{{"compliance", "matched"}};
    const Trace truth = run_reference(exact_contact, scene, 4 * below, matched).trace;
    const auto by = [&](int modes) {
        const Settings s{176400, 44100, modes, matched};
        jvari::Run r =
            run(named("modal_two_moment"), study::heard_too(named("modal_two_moment"), scene), s);
        r.trace.names.resize(scene.taps.size());
        return r.trace;
    };
    const Trace all = by(below), half = by(below / 2);
    for (const int tap : {0, 1})
        EXPECT_LT(relative_difference(all.heard(tap), truth.heard(tap)),
                  0.5 * relative_difference(all.column(tap), truth.heard(tap)))
            << tap;
    // without its share of the modes that it lacks it would be farther away than as it is
    EXPECT_LT(relative_difference(half.heard(1), truth.heard(1)),
              1.05 * relative_difference(half.column(1), truth.heard(1)));
}

Trace trace_of(const std::vector<std::vector<double>>& columns, std::size_t taps) {
    Trace t;
    t.tap_rate = 44100;
    t.rows = t.stride = static_cast<long>(columns.front().size());
    for (std::size_t k = 0; k < taps; ++k) t.names.push_back("tap" + std::to_string(k));
    for (const auto& x : columns) t.tap.insert(t.tap.end(), x.begin(), x.end());
    return t;
}
std::vector<double> tones(double high) {
    std::vector<double> x;
    for (int n = 0; n < 4410; ++n)
        x.push_back(std::sin(2 * std::numbers::pi * n * 0.01) +
                    high * std::sin(2 * std::numbers::pi * n * 0.4));
    return x;
}

TEST(Heard, ARunThatCannotBeReadByItsModesIsComparedAsItIs) {
    const Trace reference = trace_of({tones(0.1), tones(0)}, 1),
                other = trace_of({tones(0.3), tones(0)}, 1), low = trace_of({tones(0)}, 1),
                high = trace_of({tones(0.1)}, 1);
    const auto error = [&](const Trace& run, const Trace& by, std::size_t measure) {
        return study::errors_of(run, by)[0][measure];
    };
    EXPECT_NEAR(error(low, reference, heard), 0, 1e-12);
    EXPECT_NEAR(error(low, reference, whole), 0.1, 1e-3);
    EXPECT_NEAR(error(high, reference, heard), 0.1, 1e-3);
    EXPECT_NEAR(error(high, reference, whole), 0, 1e-12);
    EXPECT_NEAR(error(other, reference, heard), 0, 1e-12);  // both are read below 20 kHz
    EXPECT_NEAR(error(other, reference, whole), 0.2, 1e-3);
    EXPECT_TRUE(std::isnan(error(low, low, heard)));  // a reference that cannot be
}

study::Errors errors_by(const Scene& scene, const Trace& truth, const std::string& scheme,
                        int modes, double rate, OptionValues options) {
    const Descriptor& d = named(scheme);
    study::Cell cell{&d, {rate, 44100, modes, std::move(options)}};
    return study::errors_of(study::run_cell(cell, scene, true, [](long, long) {}), truth);
}

// The nut force has 0.4 % above 20 kHz: 133 modes err by no less, and are heard within 0.1 %.
TEST(Heard, ModesBelowTwentyKilohertzCanBeWithinATenthOfAPercent) {
    const Scene scene = c3(50e-3);
    const OptionValues matched{{"compliance", "matched"}};
    const Trace truth = run_reference(exact_contact, scene, 532, matched).trace;
    for (const int modes : {133, 200}) {
        const auto e = errors_by(scene, truth, "modal_two_moment", modes, 88200, matched);
        EXPECT_EQ(e[0][whole] > 3.5e-3, modes == 133) << modes;
        EXPECT_LT(e[0][heard], 1e-3) << modes;
        EXPECT_EQ(e[2][heard], e[2][whole]);  // a contact force has no modes
    }
    const auto grid = errors_by(scene, truth, "finite_difference_theta", 0, 88200, {});
    EXPECT_NEAR(grid[0][heard], grid[0][whole], 0.1 * grid[0][whole]);
}

TEST(Heard, EverySchemeInModesReadsThoseBelowTwentyKilohertz) {
    const Scene scene = c3(2e-3);
    int count = 0;
    for (const Descriptor& d : schemes()) {
        const Scene twice = study::heard_too(d, scene);
        if (twice == scene || !represents(d, scene)) continue;
        ++count;
        Trace t = run(d, twice, {176400, 44100, 266, {}}).trace;
        t.names.resize(scene.taps.size());
        const double apart = relative_difference(t.heard(0), t.column(0));
        EXPECT_GT(apart, 1e-4) << d.name;
        EXPECT_LT(apart, 0.1) << d.name;
        // the taps as they are do not change by being read twice
        const Trace once = run(d, scene, {176400, 44100, 266, {}}).trace;
        for (int k = 0; k < once.taps(); ++k)
            EXPECT_TRUE(std::ranges::equal(once.column(k), t.column(k))) << d.name << " " << k;
    }
    EXPECT_GE(count, 8);
}

// ---- The uncertainty

study::Truth truth_by(const Descriptor& d, const Scene& scene, int modes) {
    return study::run_truth({{&d, {0, 44100, 0, {}}, ""}}, scene, modes, 1, silent);
}

TEST(Heard, IsKnownAsWellAsTheDoublingsOfWhatIsHeardTell) {
    const Scene scene = c3(50e-3);
    const study::Truth truth = truth_by(exact_contact, scene, 532);
    const study::Trust& t = truth.reference.trust;
    const double moved =
        study::change(truth.reference.run.trace, truth.coarser.back().run.trace, 0, 0, heard);
    EXPECT_GT(moved, 0);
    EXPECT_LT(moved, study::change(truth.reference.run.trace, truth.coarser.back().run.trace, 0, 0,
                                   whole));
    EXPECT_GT(t.of_scene(0, heard), 0);
    EXPECT_LT(t.of_scene(0, heard), t.of_scene(0, whole));
    // by twice the modes
    const Trace finer =
        run_reference(exact_contact, scene, 1064, {{"compliance", "matched"}}).trace;
    const double is = study::change(finer, truth.reference.run.trace, 0, 0, heard);
    EXPECT_LT(is, t.of_scene(0, heard));
    ASSERT_EQ(truth.own.size(), 2u);
    EXPECT_FALSE(truth.own[0].heard(0).empty());
}

TEST(Heard, OfAReferenceWithoutModesNothingIsKnown) {
    const Scene scene = lasting(
        read_scene("flat_bridge_ideal", {"string.0.barrier.0.stiffness_density=rigid"}), 60e-3);
    const study::Reference r = study::run_reference(
        {{&characteristic_lattice, {0, 44100, 0, {{"cells", "420"}}}, ""}}, scene, 1, silent);
    EXPECT_TRUE(r.run.trace.heard(0).empty());
    for (std::size_t k = 0; k < r.trust.figure.size(); ++k)
        EXPECT_TRUE(std::isnan(r.trust.of_scene(k, heard)));
    EXPECT_TRUE(std::isnan(study::errors_of(r.moved.trace, r.run.trace)[0][heard]));
    EXPECT_FALSE(std::isnan(study::errors_of(r.moved.trace, r.run.trace)[0][whole]));
}

// ---- Where it can be asked for

TEST(Heard, IsNotToldByTwoRuns) {
    static const bench::compare::Catalogue catalogue;
    EXPECT_THROW(
        bench::compare::advise(c3(0.1), {.within = "1%", .measure = "heard"}, catalogue, silent),
        bench::store::UsageError);
}

TEST(Heard, IsTrimmedByOverItsWholeWindowAlone) {
    static const bench::compare::Catalogue catalogue;
    bench::trim::Request r;
    r.scene = "tanpura_c3_release", r.measure = "heard", r.within = "0.5%", r.jobs = 1;
    r.scheme = "modal_two_moment", r.reference_modes = 532;
    r.duration = 20e-3;
    EXPECT_THROW(bench::trim::Judge(r, catalogue, silent), bench::store::UsageError);
    r.duration = {};
    bench::trim::Judge judge(r, catalogue, silent);
    const bench::trim::Model m{
        {}, &named("modal_two_moment"), {88200, 44100, 133, {{"compliance", "matched"}}}};
    EXPECT_LT(judge.judged(m, 0).error, 1e-3);
    EXPECT_TRUE(judge.within(judge.judged(m, 0), 0));
    EXPECT_TRUE(judge.certain(0));
    r.scene = "flat_bridge_ideal", r.set = {"string.0.barrier.0.stiffness_density=rigid"};
    r.reference = "characteristic_lattice", r.reference_modes = 0;
    EXPECT_THROW(bench::trim::Judge(r, catalogue, silent), Refusal);
}

}  // namespace
}  // namespace jvari
