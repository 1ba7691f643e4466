// compliance=matched of the references: two programs for one system, static loads, energy, and what
// it is for.
#include "reference/in_series.hpp"
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/claims.hpp"

namespace jvari {
namespace {

const std::string exact_form = "exact_contact compliance=matched",
                  sundials_form = "sundials compliance=matched";
Run exact(const Scene& scene, int modes, const std::string& options = "") {
    return play(exact_form + options, scene, {0, 44100, modes, {}});
}
Run matched_integrated(const Scene& scene, int modes, const std::string& options = "") {
    return play(sundials_form + options, scene, {0, 44100, modes, {}});
}
Run own(const Scene& scene, int modes, const std::string& options = "") {
    return play("exact_contact" + options, scene, {0, 44100, modes, {}});
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
        barrier(scene) = {
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
            const auto a = exact(scene, 20), b = matched_integrated(scene, 20);
            ASSERT_EQ(a.status.outcome, Outcome::ok);
            ASSERT_EQ(b.status.outcome, Outcome::ok);
            EXPECT_EQ(fact(a, "events"), fact(b, "events"));
            EXPECT_EQ(fact(a, "events") > 0, exponent > 0);
            for (std::size_t k = 0; k < scene.taps.size(); ++k)
                EXPECT_LT(apart(a, b, k), exponent == 1.4 ? 1e-7 : 1e-9)
                    << exponent << " " << damping << " " << scene.taps[k].name;
        }
}

TEST(InSeries, TheyAgreeOnSeveralBarriers) {
    Scene scene = with(1, 1.2, true);
    scene.duration = 6e-3;
    scene.strings.front().start = ModeShape{3, 5e-4};
    scene.strings.front().barriers.push_back(LumpedBarrier{14e-3, 2e-3, 3e-6, {2e6}, 1, 0});
    const auto a = exact(scene, 20), b = matched_integrated(scene, 20);
    EXPECT_EQ(fact(a, "events"), fact(b, "events"));
    EXPECT_GT(fact(a, "events"), 3);
    for (int k = 0; k < 4; ++k) EXPECT_LT(apart(a, b, k), 1e-9) << k;
}

// Barrier below the string, which strikes it at up to 1 m/s.
Scene struck(double exponent, double damping, LossLaw law) {
    Scene scene = with(exponent, damping, true);
    scene.duration = 4e-3;
    scene.strings.front().start = ModeShape{3, 5e-4};
    auto& b = barrier(scene);
    b.position = 0.2;
    b.height = -2e-4;
    b.contact_loss = 3;
    b.loss_law = law;
    return scene;
}

// The point's speed, which a loss takes its force from, is changed by that force at once.
TEST(InSeries, TheyAgreeOnAContactThatLosesEnergy) {
    for (const LossLaw law : {LossLaw::hunt_crossley, LossLaw::clipped})
        for (const double exponent : {1.0, 1.4}) {
            const Scene scene = struck(exponent, 1.2, law);
            Scene lossless = scene;
            barrier(lossless).contact_loss = 0;
            const auto elastic = exact(lossless, 20);
            const auto a = exact(scene, 20), b = matched_integrated(scene, 20);
            ASSERT_EQ(a.status.outcome, Outcome::ok);
            ASSERT_EQ(b.status.outcome, Outcome::ok);
            EXPECT_GT(fact(a, "events"), 0);
            for (std::size_t k = 0; k < scene.taps.size(); ++k)
                EXPECT_LT(apart(a, b, k), 1e-7) << exponent << " " << scene.taps[k].name;
            EXPECT_GT(apart(elastic, a, 0), 1e-4) << "the loss does nothing";
            holds(LedgerClaim("", {exact_form, sundials_form}, {scene}, {{0}, 44100, 20}, {1e-9},
                              {}, false, 1));
        }
}

TEST(InSeries, WithMoreModesMatchedAndOwnApproachEachOtherWhereAContactLosesEnergy) {
    const Scene scene = struck(1, -1, LossLaw::hunt_crossley);
    for (const std::size_t tap : {0u, 1u})
        EXPECT_LT(apart(own(scene, 320), exact(scene, 320), tap),
                  0.5 * apart(own(scene, 80), exact(scene, 80), tap))
            << tap;
}

// Each touching point has two decays then, and what each takes of the energy has its room: without
// it the heap was written over.
TEST(InSeries, TwoStiffBarriersKeepTheirLedger) {
    Scene scene = read_scene("two_point_bridge",
                             {"string.0.barrier.0.exponent=1", "string.0.barrier.0.stiffness=1e9"});
    scene.duration = 12e-3;
    scene.strings.front().barriers.push_back(LumpedBarrier{12e-3, 0, -1e-5, {1e9}, 1, 0});
    holds(LedgerClaim("", {exact_form}, {scene}, {{0}, 44100, 40}, {1e-11}, {}, false, 3));
}

// Each closing of a stiff contact has a decay of R/k, 0.5 ns, in its force. A string that is
// released late in a row meets it elsewhere.
TEST(InSeries, ShorterWindowsSayTheSame) {
    for (const double exponent : {1.0, 1.4}) {
        const Scene scene = lasting(with(exponent, 1.2), 0.05);
        const auto a = exact(scene, 133, " tolerance=1e-6"),
                   b = exact(scene, 133, " tolerance=1e-13"),
                   c = exact(scene, 133, " tolerance=1e-12");
        EXPECT_EQ(fact(a, "events"), fact(b, "events"));
        EXPECT_GT(fact(a, "events"), 10);
        for (int k = 0; k < 4; ++k) {
            EXPECT_LT(apart(a, b, k), 1e-6) << exponent << " " << k;
            EXPECT_LT(apart(c, b, k), exponent == 1 ? 1e-10 : 1e-8) << exponent << " " << k;
        }
    }
}

// A contact as soft as those, with nothing in series: several spans of one solution fill a window.
TEST(InSeries, TheyAgreeOnASoftContactOfItsOwn) {
    Scene scene = with(1, 1.2);
    barrier(scene).stiffness.k = 3e6;
    const auto a = own(scene, 133), b = play("sundials", scene, {0, 44100, 133, {}});
    EXPECT_EQ(fact(a, "events"), fact(b, "events"));
    EXPECT_GT(fact(a, "events"), 2);
    EXPECT_EQ(fact(a, "contact_steps"), 0);
    for (int k = 0; k < 4; ++k) EXPECT_LT(apart(a, b, k), 1e-8) << k;
}

TEST(InSeries, AnImplicitIntegratorFollowsAStiffContact) {
    Scene scene = with(1, 1.2);
    scene.duration = 3e-3;
    const auto truth = exact(scene, 12), r = matched_integrated(scene, 12, " method=bdf rtol=1e-9");
    for (int k = 0; k < 4; ++k) EXPECT_LT(apart(r, truth, k), 1e-8) << k;
    holds(LedgerClaim("", {sundials_form + " method=bdf rtol=1e-9"}, {scene}, {{0}, 44100, 12},
                      {1e-8}));
}

TEST(InSeries, BalancesItsEnergyWhateverPartsThereAre) {
    for (const double exponent : {0.0, 1.0, 1.4})
        for (const double damping : {1.2, 0.0, -1.0}) {
            const Scene stiff = with(exponent, damping);
            Scene plucked = stiff;
            plucked.strings.front().pluck = Pluck{-0.3, 1e-3, 4, 0.4e-3, 0.4, 0.02};
            const LedgerClaim::Open open{exponent == 1.4 ? 1e-9 : 1e-11};
            holds(LedgerClaim("", {exact_form}, {stiff, plucked}, {{0}, 44100, 40}, open));
            holds(LedgerClaim("", {sundials_form}, {lasting(with(exponent, damping, true), 3e-3)},
                              {{0}, 44100, 15}, open));
        }
}

// A string pressed on a raised bridge and pulled by a low thread: at rest it yields by C_true,
// whatever the number of modes.
TEST(InSeries, AStringAtRestYieldsByTheTrueCompliance) {
    Scene scene = c3_release();
    String& s = scene.strings.front();
    s.damping = PolynomialDamping{300, 0, 0};
    s.start.reset();
    barrier(scene) = {10e-3, 2e-3, 1e-4, {1e5}, 1, 0};
    s.thread->height = -2e-5;
    scene.duration = 0.25;
    for (const std::string& form : {exact_form, sundials_form}) {
        const auto r = play(form, scene, {0, 44100, 20, {}});
        const Footprint b{10e-3, 2e-3}, c{5e-3, 1.2e-3}, x{0.3, 0};
        const double C_bb = static_deflection(s, b, b), C_bc = static_deflection(s, b, c),
                     C_cc = static_deflection(s, c, c);
        const auto last = [&](int k) { return r.trace.column(k).back(); };
        const double F_b = last(2), F_c = last(3);
        ASSERT_GT(F_b, 0.1);
        EXPECT_NEAR((C_bb * F_b + C_bc * F_c) / (1e-4 - F_b / 1e5), 1, 1e-9) << form;
        EXPECT_NEAR((C_bc * F_b + C_cc * F_c) / (-2e-5 - F_c / s.thread->stiffness), 1, 1e-9)
            << form;
        EXPECT_NEAR(last(0) / (static_nut_force(s, b) * F_b + static_nut_force(s, c) * F_c), 1,
                    1e-9)
            << form;
        EXPECT_NEAR(last(1) / (static_deflection(s, x, b) * F_b + static_deflection(s, x, c) * F_c),
                    1, 1e-9)
            << form;
    }
}

// A pluck beside the bridge, which lets it yield more than 30 modes do.
TEST(InSeries, APluckBesideTheBridgeReachesIt) {
    Scene scene = with(1, 1.2);
    scene.strings.front().pluck = Pluck{-0.3, 1e-3, 4, 0.4e-3, 0.014, 0.008};
    const auto true_one = own(scene, 800), cut = own(scene, 30), r = exact(scene, 30);
    for (const int tap : {1, 2, 3}) {  // y, bridge, thread: 9.1e-4, 4.9e-2, 7.6e-2
        EXPECT_LT(apart(r, true_one, tap), apart(cut, true_one, tap) / 15) << tap;
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
            play("modal_two_point compliance=matched", scene, {44100.0 * factor, 44100, 60, {}}));
    for (int tap = 0; tap < 4; ++tap) {
        const auto change = [&](int i) { return apart(runs[i], runs[i + 1], tap); };
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
    const Settings stepped{44100, 44100, 133, {}};
    const auto truth = own(scene, 800, " tolerance=1e-6"), exact_one = exact(scene, 133),
               matched = play("modal_two_point compliance=matched", scene, stepped),
               published = play("modal_two_point", scene, stepped);
    // y and bridge: 5.1e-5, 2.7e-3 exact in time; 2.5e-4, 1.2e-2 at 44.1 kHz
    for (const int tap : {1, 2}) {
        EXPECT_LT(apart(exact_one, truth, tap), 1.3 * (tap == 1 ? 5.1e-5 : 2.7e-3));
        EXPECT_LT(apart(matched, truth, tap), 1.2 * (tap == 1 ? 2.5e-4 : 1.2e-2));
        EXPECT_GT(apart(published, truth, tap), 20 * apart(matched, truth, tap));
    }
}

TEST(InSeries, FewModesMatchedAreNearerToManyThanManyUnmatched) {
    Scene scene = c3_release();
    scene.duration = 0.05;
    const auto truth = own(scene, 600, " tolerance=1e-6"), cut = own(scene, 133),
               with_133 = exact(scene, 133), with_20 = exact(scene, 20);
    EXPECT_EQ(fact(cut, "events"), 1357);
    EXPECT_EQ(fact(with_133, "events"), 23);
    // 1.1e-4 and 1.8e-3 of y and bridge, 4.1e-5 against 1064 modes
    EXPECT_LT(apart(with_133, truth, 1), 1.3 * 1.1e-4);
    EXPECT_LT(apart(with_133, truth, 2), 1.3 * 1.8e-3);
    EXPECT_LT(apart(with_20, truth, 1), 2 * 1.8e-3);
    EXPECT_LT(apart(with_20, truth, 2), 2 * 4.7e-2);
    for (const int tap : {1, 2})
        EXPECT_LT(10 * apart(with_133, truth, tap), apart(cut, truth, tap));
}

// A sharp corner strikes a fret: 133 matched modes are nearer than 266 as they are, and 266 than
// 133 by far.
TEST(InSeries, AStruckStringIsKnownWithHalfOfTheModes) {
    Scene scene = read_scene("guitar_over_fret");
    scene.duration = 0.02;
    const auto truth = own(scene, 1064, " tolerance=1e-8"), own_133 = own(scene, 133),
               own_266 = own(scene, 266), matched_133 = exact(scene, 133),
               matched_266 = exact(scene, 266);
    for (const int tap : {1, 2}) {  // fret and y
        const double error = apart(matched_133, truth, tap);
        EXPECT_LT(7 * error, apart(own_133, truth, tap)) << tap;
        EXPECT_LT(error, apart(own_266, truth, tap)) << tap;
        EXPECT_LT(apart(matched_266, truth, tap), 0.25 * error) << tap;
    }
}

// Harm on a bar with the 28 modes that lie below 20 kHz, exact in time. More modes cure it.
TEST(InSeries, OnABarWithFewModesItMayErrMoreThanOwnModesAndWithMoreItErrsLess) {
    Scene bar;
    bar.duration = 0.01;
    String& s = bar.strings.emplace_back();
    s.length = 0.814, s.linear_density = 1.35e-3, s.tension = 0.088, s.bending_stiffness = 0.1527;
    s.damping = PolynomialDamping{0.42, 0, 3e-6};
    s.barriers = {LumpedBarrier{46.5e-3, 5.4e-4, -2.34e-5, {2e6}, 1, 0}};
    s.thread = Thread{5.46e-3, 0, 5634, 0.0317, 0};
    s.start = TriangleShape{0.1718, 7.9e-4, 0.0369};
    bar.taps = {{"y", Quantity::displacement, 0, 0.2443}};
    const auto truth = own(bar, 448);
    const auto off = [&](const auto& r) { return apart(r, truth, 0); };
    EXPECT_GT(off(exact(bar, 28)), 3 * off(own(bar, 28)));
    EXPECT_GT(off(exact(bar, 28)), 1e-2);
    EXPECT_LT(off(exact(bar, 112)), 0.2 * off(own(bar, 112)));
}

// A bar's wide contact at 44.1 kHz: cut modes and the step each make own modes err, and the errors
// cancel. With twice the modes own errs as matched does, so matching leaves the step's error alone;
// at four times the rate matched is the nearer one.
TEST(InSeries, OwnModesMayErrLessWhereTheStepCancelsWhatTheyLeaveOut) {
    Scene bar;
    bar.duration = 0.01;
    String& s = bar.strings.emplace_back();
    s.length = 0.8855, s.linear_density = 8.797e-4, s.tension = 0.03, s.bending_stiffness = 0.0177;
    s.barriers = {LumpedBarrier{0.72735, 27.99e-3, 2.175e-5, {7.86e6}, 1, 0}};
    s.thread = Thread{18.8e-3, 0, 2066, 0.0588, 0};
    s.start = ModeShape{4, 4.19e-5};
    bar.taps = {{"y", Quantity::displacement, 0, 0.2656}, {"bridge", Quantity::bridge_force, 0, 0}};
    const auto truth = exact(bar, 376);
    for (const int tap : {0, 1}) {
        const auto off = [&](const char* compliance, int modes, double rate) {
            return apart(play(std::string("modal_two_moment compliance=") + compliance, bar,
                              {rate, 44100, modes, {}}),
                         truth, tap);
        };
        const double matched = off("matched", 47, 44100);
        EXPECT_GT(matched, 3 * off("own", 47, 44100)) << tap;
        EXPECT_NEAR(off("own", 94, 44100), matched, 0.05 * matched) << tap;
        EXPECT_LT(3 * off("matched", 47, 176400), off("own", 47, 176400)) << tap;
    }
}

}  // namespace
}  // namespace jvari
