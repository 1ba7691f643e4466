// A rigid point under a string, where only what the cut modes lack gives way: the point bridge of
// Issanchou et al. 2016, released.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace jvari {
namespace {

Scene over(const std::string& stiffness) {
    Scene scene = read_scene("two_point_bridge",
                             {"string.0.barrier.0.exponent=1", "string.0.initial.smoothing=0.1",
                              "string.0.barrier.0.stiffness=" + stiffness});
    scene.duration = 12e-3;
    return scene;
}
constexpr int y10mm = 0, y03 = 1;

Trace motion(const char* scheme, const Scene& scene, int modes, const char* compliance,
             double rate = 64000) {
    const Descriptor& d =
        std::string(scheme) == exact_contact.name
            ? exact_contact
            : *std::find_if(schemes().begin(), schemes().end(), [scheme](const Descriptor& one) {
                  return one.name == std::string(scheme);
              });
    const Settings s{
        d.clock == Clock::continuous ? 0 : rate, 64000, modes, {{"compliance", compliance}}};
    const jvari::Run r = run(d, scene, s);
    EXPECT_EQ(r.status.outcome, Outcome::ok);
    return r.trace;
}
double difference(const Trace& a, const Trace& b, int tap) {  // relative, L2
    double d = 0, n = 0;
    for (long i = 0; i < std::min(a.rows, b.rows); ++i) {
        d += std::pow(a.column(tap)[i] - b.column(tap)[i], 2);
        n += std::pow(b.column(tap)[i], 2);
    }
    return std::sqrt(d / n);
}

TEST(RigidBarrier, FortyMatchedModesAreWithinThreeThousandthsOfAThousand) {
    const Scene scene = over("rigid");
    const Trace truth = motion("exact_contact", scene, 1000, "matched");
    EXPECT_LT(difference(motion("exact_contact", scene, 40, "matched"), truth, y03), 3e-3);
    EXPECT_LT(difference(motion("modal_two_point", scene, 40, "matched"), truth, y03), 3e-3);
    EXPECT_LT(difference(motion("modal_two_point", scene, 40, "matched", 512000), truth, y03),
              3e-3);
    EXPECT_GT(difference(motion("modal_two_point", scene, 40, "own"), truth, y03), 1e-2)
        << "matching adds nothing";
}

TEST(RigidBarrier, IsWhatASpringTendsToAsItStiffens) {
    const Trace truth = motion("exact_contact", over("rigid"), 40, "matched");
    const auto away = [&](const char* k) {
        return difference(motion("exact_contact", over(k), 40, "matched"), truth, y10mm);
    };
    const double soft = away("1e8"), stiff = away("1e9"), stiffest = away("1e10");
    EXPECT_NEAR(soft / stiff, 10, 0.5);
    EXPECT_NEAR(stiff / stiffest, 10, 0.5);
    EXPECT_LT(stiffest, 1e-5);
}

TEST(RigidBarrier, TwoPointsAreSolvedTogether) {
    Scene scene = over("rigid");
    scene.strings[0].barriers.push_back(LumpedBarrier{0.012, 0, -1e-5, {rigid}, 1, 0});
    const Trace truth = motion("exact_contact", scene, 160, "matched");
    EXPECT_LT(difference(motion("exact_contact", scene, 40, "matched"), truth, y03), 3e-3);
    EXPECT_LT(difference(motion("modal_two_point", scene, 40, "matched", 512000), truth, y03),
              3e-3);
}

// Where that ends: with a corner, or with the point in the open string,
// 40 matched modes err by some thousandths, a law of impact by hundredths.
TEST(RigidBarrier, ACornerAndAPointInTheOpenStringAskForMoreModes) {
    for (const bool corner : {true, false}) {
        Scene scene = over("rigid");
        if (corner) std::get<TriangleInitial>(*scene.strings[0].initial).smoothing = 0;
        else std::get<LumpedBarrier>(scene.strings[0].barriers[0]).position = 0.4;
        const Trace truth = motion("exact_contact", scene, 500, "matched");
        const double matched =
            difference(motion("modal_two_point", scene, 40, "matched", 704000), truth, y03);
        EXPECT_LT(matched, 7e-3) << corner;
        EXPECT_GT(matched, 1e-3) << corner;
        EXPECT_GT(difference(motion("modal_moreau_jean", scene, 40, "own", 704000), truth, y03),
                  5 * matched)
            << corner;
    }
}

TEST(RigidBarrier, AProfileOfRigidPointsIsKnownToFewMatchedModesToo) {
    Scene scene = read_scene("sitar_parabola", {"string.0.barrier.0.stiffness_density=rigid",
                                                "string.0.barrier.0.exponent=1"});
    scene.duration = 5e-3;
    constexpr int y = 2;  // y03
    const Trace truth = motion("modal_two_point", scene, 320, "matched", 704000);
    EXPECT_LT(difference(motion("modal_two_point", scene, 40, "matched", 704000), truth, y), 5e-3);
    EXPECT_GT(difference(motion("modal_two_point", scene, 40, "own", 704000), truth, y), 1e-2);
}

TEST(RigidBarrier, TheReferenceNeedsWhatGivesWayAndSaysSo) {
    try {
        motion("exact_contact", over("rigid"), 40, "own");
        ADD_FAILURE() << "not refused";
    } catch (const Refusal& r) {
        EXPECT_NE(std::string(r.what()).find("compliance=matched"), std::string::npos) << r.what();
    }
}

TEST(RigidBarrier, TheTwoPointStringRefusesAStartInsideItAndASofterOneBesideIt) {
    const auto refusal = [](const Scene& scene) -> std::string {
        try {
            motion("modal_two_point", scene, 40, "matched");
        } catch (const Refusal& r) { return r.what(); }
        return "";
    };
    Scene inside = over("rigid"), beside = inside;
    std::get<LumpedBarrier>(inside.strings[0].barriers[0]).height = 1e-3;
    EXPECT_NE(refusal(inside).find("inside a rigid barrier"), std::string::npos);
    beside.strings[0].barriers.push_back(LumpedBarrier{0.02, 0, 0, {1e8}, 1, 0});
    EXPECT_NE(refusal(beside).find("beside one that gives way"), std::string::npos);
}

}  // namespace
}  // namespace jvari
