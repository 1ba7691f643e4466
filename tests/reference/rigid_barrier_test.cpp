// A rigid point under a string, where only what the cut modes lack gives way: the point bridge of
// Issanchou et al. 2016, released.
#include <chrono>
#include <stdexcept>

#include "scenes/scene_file.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

Scene over(const std::string& stiffness) {
    Scene scene = read_scene("two_point_bridge",
                             {"string.0.barrier.0.exponent=1", "string.0.start.smoothing=0.1",
                              "string.0.barrier.0.stiffness=" + stiffness});
    scene.duration = 12e-3;
    return scene;
}
constexpr int y10mm = 0, y03 = 1;

Run motion(const std::string& scheme, const Scene& scene, int modes, const std::string& compliance,
           double rate = 64000) {
    const auto r = play(scheme + " compliance=" + compliance, scene, {rate, 64000, modes, {}});
    EXPECT_EQ(r.status.outcome, Outcome::ok);
    return r;
}

RunOptions with_an_answer_within_20_s() {
    RunOptions options;
    options.progress = [start = std::chrono::steady_clock::now()](long, long) {
        if (std::chrono::steady_clock::now() - start > std::chrono::seconds(20))
            throw std::runtime_error("no answer within 20 s");
    };
    return options;
}

TEST(RigidBarrier, FortyMatchedModesAreWithinThreeThousandthsOfAThousand) {
    const Scene scene = over("rigid");
    const auto truth = motion("exact_contact", scene, 1000, "matched");
    EXPECT_LT(apart(motion("exact_contact", scene, 40, "matched"), truth, y03), 3e-3);
    EXPECT_LT(apart(motion("modal_two_point", scene, 40, "matched"), truth, y03), 3e-3);
    EXPECT_LT(apart(motion("modal_two_point", scene, 40, "matched", 512000), truth, y03), 3e-3);
    EXPECT_GT(apart(motion("modal_two_point", scene, 40, "own"), truth, y03), 1e-2)
        << "matching adds nothing";
}

TEST(RigidBarrier, IsWhatASpringTendsToAsItStiffens) {
    const auto truth = motion("exact_contact", over("rigid"), 40, "matched");
    const auto away = [&](const char* k) {
        return apart(motion("exact_contact", over(k), 40, "matched"), truth, y10mm);
    };
    const double soft = away("1e8"), stiff = away("1e9"), stiffest = away("1e10");
    EXPECT_NEAR(soft / stiff, 10, 0.5);
    EXPECT_NEAR(stiff / stiffest, 10, 0.5);
    EXPECT_LT(stiffest, 1e-5);
}

// With eight modes the string grazes the point. In steps of the rigid spring's own size contacts of
// 1e-11 windows would follow one another, millions of them.
TEST(RigidBarrier, IsGrazedByFewModesAtOnce) {
    Scene scene = read_scene("rigid_point_bridge");
    scene.duration = 9e-3;
    RunOptions options = with_an_answer_within_20_s();
    options.energy = true;
    const Settings eight{0, 44100, 8, {{"compliance", "matched"}}};
    const auto r = run(exact_contact, scene, eight, options);
    EXPECT_EQ(r.status.outcome, Outcome::ok);
    EXPECT_LE(ledger(r.trace).sum, 1e-12);
    EXPECT_GT(ledger(r.trace).lost, 1e-6);
}

// Beside a thread one pair of rates of what is in series is fast and one is slow. Its energy took
// nodes that followed the fast one, two minutes for these rows.
TEST(RigidBarrier, ItsEnergyIsKnownAtOnceBesideAThread) {
    Scene scene = read_scene("tanpura_c3_release", {"string.0.barrier.0.stiffness=\"rigid\"",
                                                    "string.0.barrier.0.width=0"});
    scene.duration = 4.5e-3;
    RunOptions options = with_an_answer_within_20_s();
    options.energy = true;
    const auto r = run(exact_contact, scene, {0, 44100, 133, {{"compliance", "matched"}}}, options);
    EXPECT_LE(ledger(r.trace).sum, 1e-12);
    EXPECT_GT(ledger(r.trace).lost, 1e-3);
}

// Beside a stiff thread a closed contact leaves a motion as slow as the string's, since windows
// follow the thread. Contact steps of a rigid spring's own size took minutes for these rows.
TEST(RigidBarrier, BesideAStiffThreadItLeavesASlowMotionAndEndsAtOnce) {
    Scene scene = read_scene(
        "two_point_bridge",
        {"string.0.barrier.0.exponent=1", "string.0.barrier.0.position=0.0418",
         "string.0.start={shape=\"triangle\",position=0.09,amplitude=1e-3,smoothing=5e-3}",
         "string.0.thread={position=0.0209,stiffness=3.4e6,damping=0.58}"});
    String& s = scene.strings[0];
    s.length = 0.65, s.linear_density = 2e-3, s.tension = 280, s.bending_stiffness = 3.4e-3;
    s.damping = PolynomialDamping{0.17, 0.036, 5.6e-6};
    scene.duration = 5e-3;
    const auto over_stiffness = [&](double k, int modes) {
        std::get<LumpedBarrier>(s.barriers[0]).stiffness.k = k;
        RunOptions options = with_an_answer_within_20_s();
        options.energy = true;
        const auto r =
            run(exact_contact, scene, {0, 44100, modes, {{"compliance", "matched"}}}, options);
        EXPECT_EQ(r.status.outcome, Outcome::ok);
        EXPECT_LE(ledger(r.trace).sum, 1e-12) << modes;
        EXPECT_GT(ledger(r.trace).lost, 0.05) << modes;
        return r;
    };
    for (const int modes : {8, 26, 52}) {
        const auto stiffest = over_stiffness(rigid, modes), stiff = over_stiffness(1e11, modes),
                   softer = over_stiffness(1e10, modes);
        const double near = apart(stiff, stiffest, y03);
        EXPECT_GT(near, 0);
        EXPECT_LT(near, 2e-6);
        EXPECT_NEAR(apart(softer, stiffest, y03) / near, 10, 1) << modes;
    }
}

TEST(RigidBarrier, TwoPointsAreSolvedTogether) {
    Scene scene = over("rigid");
    scene.strings[0].barriers.push_back(LumpedBarrier{0.012, 0, -1e-5, {rigid}, 1, 0});
    const auto truth = motion("exact_contact", scene, 160, "matched");
    EXPECT_LT(apart(motion("exact_contact", scene, 40, "matched"), truth, y03), 3e-3);
    EXPECT_LT(apart(motion("modal_two_point", scene, 40, "matched", 512000), truth, y03), 3e-3);
}

// Where that ends: with a corner, or with the point in the open string,
// 40 matched modes err by some thousandths, a law of impact by hundredths.
TEST(RigidBarrier, ACornerAndAPointInTheOpenStringAskForMoreModes) {
    for (const bool corner : {true, false}) {
        Scene scene = over("rigid");
        if (corner) std::get<TriangleShape>(*scene.strings[0].start).smoothing = 0;
        else std::get<LumpedBarrier>(scene.strings[0].barriers[0]).position = 0.4;
        const auto truth = motion("exact_contact", scene, 500, "matched");
        const double matched =
            apart(motion("modal_two_point", scene, 40, "matched", 704000), truth, y03);
        EXPECT_LT(matched, 7e-3) << corner;
        EXPECT_GT(matched, 1e-3) << corner;
        EXPECT_GT(apart(motion("modal_moreau_jean", scene, 40, "own", 704000), truth, y03),
                  5 * matched)
            << corner;
    }
}

// Why no scene may have both a width and a rigid barrier: the averaged point has a mass, and what
// stands in series with it takes the whole blow. The stiffness that is named instead gives it back.
TEST(RigidBarrier, OverAWidthItWouldTakeEnergyThatNoLawSpeaksOf) {
    Scene scene = lasting(read_scene("guitar_over_fret", {"string.0.start.smoothing=0.02",
                                                          "string.0.damping={law=\"none\"}"}),
                          5e-3);
    RunOptions options;
    options.energy = true;
    const auto taken = [&](double stiffness) {
        std::get<LumpedBarrier>(scene.strings[0].barriers[0]).stiffness.k = stiffness;
        const auto r =
            run(exact_contact, scene, {0, 44100, 1064, {{"compliance", "matched"}}}, options);
        const auto stored = r.trace.energy_column(0);
        return 1 - stored.back() / stored.front();
    };
    EXPECT_GT(taken(rigid), 4e-3);
    EXPECT_THROW(validate(scene), BadScene);
    EXPECT_LT(taken(1e10), 5e-4);
}

TEST(RigidBarrier, AProfileOfRigidPointsIsKnownToFewMatchedModesToo) {
    Scene scene = read_scene("sitar_parabola", {"string.0.barrier.0.stiffness_density=rigid",
                                                "string.0.barrier.0.exponent=1"});
    scene.duration = 5e-3;
    constexpr int y = 2;  // y03
    const auto truth = motion("modal_two_point", scene, 320, "matched", 704000);
    EXPECT_LT(apart(motion("modal_two_point", scene, 40, "matched", 704000), truth, y), 5e-3);
    EXPECT_GT(apart(motion("modal_two_point", scene, 40, "own", 704000), truth, y), 1e-2);
}

}  // namespace
}  // namespace jvari
