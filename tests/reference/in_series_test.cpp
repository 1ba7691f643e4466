// compliance=matched of the references: two programs for one system, static loads, energy, and what
// it is for.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/in_series.hpp"
#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"
#include "tests/ledger.hpp"

namespace jvari {
namespace {

Settings matched(int modes) { return {0, 44100, modes, {{"compliance", "matched"}}}; }
LumpedBarrier& bridge(Scene& scene) {
    return std::get<LumpedBarrier>(scene.strings.front().barriers.front());
}
double fact(const jvari::Run& r, const std::string& name) {
    for (const Fact& f : r.facts)
        if (f.name == name) return f.value;
    ADD_FAILURE() << "no fact " << name;
    return 0;
}
// relative L2 over the shorter
double difference(std::span<const double> a, std::span<const double> b) {
    double d = 0, n = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        d += (a[i] - b[i]) * (a[i] - b[i]), n += b[i] * b[i];
    return n == 0 ? std::sqrt(d) : std::sqrt(d / n);
}

const Descriptor& two_point() {
    return *std::find_if(schemes().begin(), schemes().end(), [](const Descriptor& d) {
        return d.name == std::string("modal_two_point");
    });
}

// Barrier and thread in every combination, at heights of their own: `exponent` 0 leaves the barrier
// out, `damping` < 0 the thread. soft: for Adams' method, whose steps follow the decay of a point
// without mass, R/k.
Scene with(double exponent, double damping, bool soft = false) {
    Scene scene = c3_release();
    String& s = scene.strings.front();
    scene.duration = 0.01;
    s.thread->height = 1e-5;
    s.thread->damping = damping;
    if (damping < 0) s.thread.reset();
    if (exponent == 0) s.barriers.clear();
    else
        bridge(scene) = {
            10e-3,    2e-3, 1e-6, {soft ? exponent == 1 ? 1e6 : 1e8 : exponent == 1 ? 4.39e8 : 3e9},
            exponent, 0};
    return scene;
}

TEST(InSeries, ExactContactAndSundialsAgreeOnWhatIsMatched) {
    for (const double exponent : {0.0, 1.0, 1.4})
        for (const double damping : {1.2, 0.0, -1.0}) {
            if (exponent == 0 && damping < 0) continue;
            Scene scene = with(exponent, damping, true);
            scene.duration = 5e-3;
            const auto a = run(exact_contact, scene, matched(20)),
                       b = run(sundials, scene, matched(20));
            ASSERT_EQ(a.status.outcome, Outcome::ok);
            ASSERT_EQ(b.status.outcome, Outcome::ok);
            EXPECT_EQ(fact(a, "events"), fact(b, "events"));
            EXPECT_EQ(fact(a, "events") > 0, exponent > 0);
            for (std::size_t k = 0; k < scene.taps.size(); ++k)
                EXPECT_LT(difference(a.trace.column(k), b.trace.column(k)),
                          exponent == 1.4 ? 1e-7 : 1e-9)
                    << exponent << " " << damping << " " << scene.taps[k].name;
        }
}

TEST(InSeries, TheyAgreeOnSeveralBarriers) {
    Scene scene = with(1, 1.2, true);
    scene.duration = 6e-3;
    scene.strings.front().initial = ModeInitial{3, 5e-4};
    scene.strings.front().barriers.push_back(LumpedBarrier{14e-3, 2e-3, 3e-6, {2e6}, 1, 0});
    const auto a = run(exact_contact, scene, matched(20)), b = run(sundials, scene, matched(20));
    EXPECT_EQ(fact(a, "events"), fact(b, "events"));
    EXPECT_GT(fact(a, "events"), 3);
    for (int k = 0; k < 4; ++k)
        EXPECT_LT(difference(a.trace.column(k), b.trace.column(k)), 1e-9) << k;
}

// Each touching point has two decays then, and what each takes of the energy has its room: without
// it the heap was written over.
TEST(InSeries, TwoStiffBarriersKeepTheirLedger) {
    Scene scene = read_scene("two_point_bridge",
                             {"string.0.barrier.0.exponent=1", "string.0.barrier.0.stiffness=1e9"});
    scene.duration = 12e-3;
    scene.strings.front().barriers.push_back(LumpedBarrier{12e-3, 0, -1e-5, {1e9}, 1, 0});
    const auto a = run(exact_contact, scene, matched(40), {.energy = true});
    ASSERT_EQ(a.status.outcome, Outcome::ok);
    EXPECT_GT(fact(a, "events"), 3);
    EXPECT_LT(ledger(a.trace).worst_step, 1e-11);
}

// Each closing of a stiff contact has a decay of R/k, 0.5 ns, in its force. A string that is
// released late in a row meets it elsewhere.
TEST(InSeries, ShorterWindowsSayTheSame) {
    for (const double exponent : {1.0, 1.4}) {
        Scene scene = with(exponent, 1.2);
        scene.duration = 0.05;
        Settings coarse = matched(133), fine = matched(133);
        coarse.options.push_back({"tolerance", "1e-6"});
        fine.options.push_back({"tolerance", "1e-13"});
        const auto a = run(exact_contact, scene, coarse), b = run(exact_contact, scene, fine);
        EXPECT_EQ(fact(a, "events"), fact(b, "events"));
        EXPECT_GT(fact(a, "events"), 10);
        for (std::size_t k = 0; k < scene.taps.size(); ++k)
            EXPECT_LT(difference(a.trace.column(k), b.trace.column(k)), 1e-6)
                << exponent << " " << scene.taps[k].name;
        fine.options.back().second = "1e-12";
        const auto c = run(exact_contact, scene, fine);
        for (std::size_t k = 0; k < scene.taps.size(); ++k)
            EXPECT_LT(difference(c.trace.column(k), b.trace.column(k)),
                      exponent == 1 ? 1e-10 : 1e-8)
                << exponent << " " << scene.taps[k].name;
    }
}

// A contact as soft as those, with nothing in series: several spans of one solution fill a window.
TEST(InSeries, TheyAgreeOnASoftContactOfItsOwn) {
    Scene scene = with(1, 1.2);
    bridge(scene).stiffness.k = 3e6;
    const auto a = run(exact_contact, scene, {0, 44100, 133, {}}),
               b = run(sundials, scene, {0, 44100, 133, {}});
    EXPECT_EQ(fact(a, "events"), fact(b, "events"));
    EXPECT_GT(fact(a, "events"), 2);
    EXPECT_EQ(fact(a, "contact_steps"), 0);
    for (int k = 0; k < 4; ++k)
        EXPECT_LT(difference(a.trace.column(k), b.trace.column(k)), 1e-8) << k;
}

TEST(InSeries, AnImplicitIntegratorFollowsAStiffContact) {
    Scene scene = with(1, 1.2);
    scene.duration = 3e-3;
    const auto exact = run(exact_contact, scene, matched(12));
    Settings s = matched(12);
    s.options.insert(s.options.end(), {{"method", "bdf"}, {"rtol", "1e-9"}});
    const auto r = run(sundials, scene, s, {.energy = true});
    EXPECT_LE(ledger(r.trace).worst_step, 1e-8);
    for (int k = 0; k < 4; ++k)
        EXPECT_LT(difference(r.trace.column(k), exact.trace.column(k)), 1e-8) << k;
}

TEST(InSeries, BalancesItsEnergyWhateverPartsThereAre) {
    for (const bool plucked : {false, true})
        for (const double exponent : {0.0, 1.0, 1.4})
            for (const double damping : {1.2, 0.0, -1.0}) {
                const Scene stiff = with(exponent, damping), soft = with(exponent, damping, true);
                for (const Descriptor* d : {&exact_contact, &sundials}) {
                    Scene scene = d == &sundials ? soft : stiff;
                    if (plucked)
                        scene.strings.front().pluck = Pluck{-0.3, 1e-3, 4, 0.4e-3, 0.4, 0.02};
                    if (plucked && d == &sundials) continue;
                    if (d == &sundials) scene.duration = 3e-3;
                    const auto r =
                        run(*d, scene, matched(d == &sundials ? 15 : 40), {.energy = true});
                    ASSERT_EQ(r.status.outcome, Outcome::ok);
                    EXPECT_LE(ledger(r.trace).worst_step, exponent == 1.4 ? 1e-9 : 1e-11)
                        << d->name << " " << plucked << " " << exponent << " " << damping;
                }
            }
}

// A string pressed on a raised bridge and pulled by a low thread: at rest it yields by C_true,
// whatever the number of modes.
TEST(InSeries, AStringAtRestYieldsByTheTrueCompliance) {
    Scene scene = c3_release();
    String& s = scene.strings.front();
    s.damping = PolynomialDamping{300, 0, 0};
    s.initial.reset();
    bridge(scene) = {10e-3, 2e-3, 1e-4, {1e5}, 1, 0};
    s.thread->height = -2e-5;
    scene.duration = 0.25;
    for (const Descriptor* d : {&exact_contact, &sundials}) {
        const auto r = run(*d, scene, matched(20));
        const Footprint b{10e-3, 2e-3}, c{5e-3, 1.2e-3}, x{0.3, 0};
        const double C_bb = static_deflection(s, b, b), C_bc = static_deflection(s, b, c),
                     C_cc = static_deflection(s, c, c);
        const auto last = [&](int k) { return r.trace.column(k).back(); };
        const double F_b = last(2), F_c = last(3);
        ASSERT_GT(F_b, 0.1);
        EXPECT_NEAR((C_bb * F_b + C_bc * F_c) / (1e-4 - F_b / 1e5), 1, 1e-9) << d->name;
        EXPECT_NEAR((C_bc * F_b + C_cc * F_c) / (-2e-5 - F_c / s.thread->stiffness), 1, 1e-9)
            << d->name;
        EXPECT_NEAR(last(0) / (static_nut_force(s, b) * F_b + static_nut_force(s, c) * F_c), 1,
                    1e-9)
            << d->name;
        EXPECT_NEAR(last(1) / (static_deflection(s, x, b) * F_b + static_deflection(s, x, c) * F_c),
                    1, 1e-9)
            << d->name;
    }
}

// A pluck beside the bridge, which lets it yield more than 30 modes do.
TEST(InSeries, APluckBesideTheBridgeReachesIt) {
    Scene scene = with(1, 1.2);
    scene.strings.front().pluck = Pluck{-0.3, 1e-3, 4, 0.4e-3, 0.014, 0.008};
    const auto true_one = run(exact_contact, scene, {0, 44100, 800, {}}),
               own = run(exact_contact, scene, {0, 44100, 30, {}}),
               r = run(exact_contact, scene, matched(30));
    for (const int tap : {1, 2, 3}) {  // y, bridge, thread: 9.1e-4, 4.9e-2, 7.6e-2
        const auto error = [&](const jvari::Run& of) {
            return difference(of.trace.column(tap), true_one.trace.column(tap));
        };
        EXPECT_LT(error(r), error(own) / 15) << tap;
    }
}

// A point without mass meets its obstacle without a blow: its force has no jump, and the difference
// to the run at twice the rate falls by four. In the published contact, whose every closing is a
// blow, that at the bridge falls by 2.5 here.
TEST(InSeries, TheTwoPointSchemeIsOfOrderTwoWithContact) {
    Scene scene = with(1, 1.2);
    scene.duration = 0.02;
    std::vector<jvari::Run> runs;
    for (const int factor : {8, 16, 32, 64, 128})
        runs.push_back(
            run(two_point(), scene, {44100.0 * factor, 44100, 60, {{"compliance", "matched"}}}));
    for (int tap = 0; tap < 4; ++tap) {
        const auto change = [&](int i) {
            return difference(runs[i].trace.column(tap), runs[i + 1].trace.column(tap));
        };
        const double order = std::log2(change(0) / change(3)) / 3;
        EXPECT_GT(order, 1.85) << scene.taps[tap].name;
        EXPECT_LT(order, 2.3) << scene.taps[tap].name;
    }
}

// Points nearer to each other than half the shortest wave that is kept, 7.5 mm: a damper at each
// and the whole matrix C are enough.
TEST(InSeries, PointsNearEachOtherAreAsGoodAsOne) {
    Scene scene = c3_release();
    scene.duration = 0.02;
    scene.strings.front().barriers = {LumpedBarrier{10e-3, 1e-3, 0, {4.39e8}, 1, 0},
                                      LumpedBarrier{13e-3, 1e-3, 0, {4.39e8}, 1, 0}};
    const auto truth = run(exact_contact, scene, {0, 44100, 800, {{"tolerance", "1e-6"}}});
    const auto exact = run(exact_contact, scene, matched(133)),
               stepped = run(two_point(), scene, {44100, 44100, 133, {{"compliance", "matched"}}});
    const auto published = run(two_point(), scene, {44100, 44100, 133, {}});
    // y and bridge: 5.1e-5, 2.7e-3 exact in time; 2.5e-4, 1.2e-2 at 44.1 kHz
    for (const int tap : {1, 2}) {
        const auto error = [&](const jvari::Run& r) {
            return difference(r.trace.column(tap), truth.trace.column(tap));
        };
        EXPECT_LT(error(exact), 1.3 * (tap == 1 ? 5.1e-5 : 2.7e-3));
        EXPECT_LT(error(stepped), 1.2 * (tap == 1 ? 2.5e-4 : 1.2e-2));
        EXPECT_GT(error(published), 20 * error(stepped));
    }
}

TEST(InSeries, FewModesMatchedAreNearerToManyThanManyUnmatched) {
    Scene scene = c3_release();
    scene.duration = 0.05;
    const auto truth = run(exact_contact, scene, {0, 44100, 600, {{"tolerance", "1e-6"}}});
    const auto cut = run(exact_contact, scene, {0, 44100, 133, {}}),
               with_133 = run(exact_contact, scene, matched(133)),
               with_20 = run(exact_contact, scene, matched(20));
    EXPECT_EQ(fact(cut, "events"), 1357);
    EXPECT_EQ(fact(with_133, "events"), 23);
    const auto error = [&](const jvari::Run& r, int tap) {
        return difference(r.trace.column(tap), truth.trace.column(tap));
    };
    // 1.1e-4 and 1.8e-3 of y and bridge, 4.1e-5 against 1064 modes
    EXPECT_LT(error(with_133, 1), 1.3 * 1.1e-4);
    EXPECT_LT(error(with_133, 2), 1.3 * 1.8e-3);
    EXPECT_LT(error(with_20, 1), 2 * 1.8e-3);
    EXPECT_LT(error(with_20, 2), 2 * 4.7e-2);
    for (const int tap : {1, 2}) EXPECT_LT(10 * error(with_133, tap), error(cut, tap));
}

// A sharp corner strikes a fret: 133 matched modes are nearer than 266 as they are, and 266 than
// 133 by far.
TEST(InSeries, AStruckStringIsKnownWithHalfOfTheModes) {
    Scene scene = read_scene("guitar_over_fret");
    scene.duration = 0.02;
    const auto truth = run(exact_contact, scene, {0, 44100, 1064, {{"tolerance", "1e-8"}}});
    const auto error = [&](int modes, const char* form, int tap) {
        const auto r = run(exact_contact, scene, {0, 44100, modes, {{"compliance", form}}});
        return difference(r.trace.column(tap), truth.trace.column(tap));
    };
    for (const int tap : {1, 2}) {  // fret and y
        EXPECT_LT(7 * error(133, "matched", tap), error(133, "own", tap)) << tap;
        EXPECT_LT(error(133, "matched", tap), error(266, "own", tap)) << tap;
        EXPECT_LT(error(266, "matched", tap), 0.25 * error(133, "matched", tap)) << tap;
    }
}

TEST(InSeries, RefusesWhatItCannotCarry) {
    Scene lossy = c3_release(), profile = c3_release(), plucked = c3_pluck();
    bridge(lossy).contact_loss = 0.1;
    profile.strings.front().barriers = {ProfileBarrier{FlatCurve{}, 5e-3, 15e-3, {1e11}, 1, 0}};
    for (const Descriptor* d : {&exact_contact, &sundials})
        for (const Scene* scene : {&lossy, &profile})
            EXPECT_THROW(make_scheme(*d, *scene, matched(20)), Refusal) << d->name;
    EXPECT_THROW(make_scheme(sundials, plucked, matched(20)), Refusal);
    EXPECT_NO_THROW(make_scheme(exact_contact, plucked, matched(20)));
}

}  // namespace
}  // namespace jvari
