// Certificates as they are computed: which references run, which are compared, what is doubled.
#include <gtest/gtest.h>

#include "bench/study/certificate.hpp"
#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"

namespace jvari::test {
namespace {

using bench::study::Certificate;

Certificate certified(const Scene& scene, const bench::study::CertifySettings& settings) {
    return certify(scene, certificate_plan(scene, settings));
}

Scene release(double duration) {
    Scene scene = c3_release();
    scene.duration = duration;
    return scene;
}

const Certificate::Options matched_alone{{"compliance", "matched"}};

TEST(Certificate, ShowsThatTheReferencesAgree) {
    const Certificate c = certified(release(6e-3), {40, 44100});
    ASSERT_EQ(c.entries.size(), 6u);
    EXPECT_EQ(c.entries[0].reference, "exact_contact");
    EXPECT_EQ(c.entries[2].reference, "sundials");
    EXPECT_EQ(c.entries[3].options, matched_alone);
    EXPECT_EQ(c.entries[5].doubled, "modes");
    EXPECT_EQ(c.entries[5].options, matched_alone);
    // 3 of own compliance, 1 matched; the last two with the defaults of their own reference alone
    ASSERT_EQ(c.pairs.size(), 6u);
    for (std::size_t k = 0; k < 4; ++k) {
        const bool first = is_matched(c.entries[c.pairs[k].first].options),
                   second = is_matched(c.entries[c.pairs[k].second].options);
        EXPECT_EQ(first, second) << k;
    }
    for (const auto& [pair, with] : {std::pair(4, 0), std::pair(5, 3)}) {
        EXPECT_EQ(c.pairs[pair].first, 5);
        EXPECT_EQ(c.pairs[pair].second, with);
    }
    for (const auto& e : c.entries) {
        EXPECT_EQ(e.status.outcome, Outcome::ok);
        EXPECT_GT(e.wall_seconds, 0);
        EXPECT_NEAR(e.reached, 6e-3, 1e-4);
    }
    for (const auto& pair : c.pairs) {
        if (pair.first >= 5) continue;
        // nut
        EXPECT_LT(pair.taps[0].relative_l2.back(), 1e-9) << pair.first << " " << pair.second;
        // bridge
        EXPECT_LT(pair.taps[2].relative_l2.back(), 1e-6) << pair.first << " " << pair.second;
        EXPECT_NEAR(pair.taps[0].until[2], 6e-3, 1e-4);
    }
    EXPECT_GT(c.floor[0].relative_l2.back(), 1e-13);
    EXPECT_LT(c.floor[0].relative_l2.back(), 1e-10);
}

// 60 modes are far from the string: what all references of 60 modes agree about to 1e-9 is wrong by
// more than 1e-2.
TEST(Certificate, SaysWhatTwiceTheModesAndTwiceThePointsChange) {
    const Scene scene = release(10e-3);
    const Certificate c = certified(scene, {60, 44100});
    const Certificate::Pair &from_own = c.pairs[c.pairs.size() - 2], &doubled = c.pairs.back();
    ASSERT_EQ(c.entries[doubled.first].doubled, "modes");
    const auto trace = [&scene](int modes, const Certificate::Options& options) {
        return run(exact_contact, scene, {0, 44100, modes, options}).trace;
    };
    const Trace own = trace(60, {}), model = trace(60, matched_alone),
                twice = trace(120, matched_alone), string = trace(600, matched_alone);
    for (int k = 0; k < model.taps(); ++k) {
        const double further = (and_further_ones - 1) * doubled.taps[k].relative_l2.back();
        for (const auto& [trace, pair] :
             {std::pair(&own, &from_own), std::pair(&model, &doubled)}) {
            const double changed = pair->taps[k].relative_l2.back();
            EXPECT_DOUBLE_EQ(changed,
                             relative_difference(twice.column(k), trace->column(k), 44100, 1));
            EXPECT_LT(relative_difference(string.column(k), trace->column(k), 44100, 1),
                      changed + further);  // of the norm of what is trusted
        }
    }
    EXPECT_GT(from_own.taps[0].relative_l2.back(), 1e-2);
    EXPECT_LT(doubled.taps[2].relative_l2.back(), 0.1 * from_own.taps[2].relative_l2.back());

    Scene profile = scene;
    profile.duration = 2e-3;
    profile.strings[0].barriers = {ProfileBarrier{ParabolaCurve{0.05}, 0, 0.02, {1e10}, 1, 0}};
    profile.strings[0].thread.reset();
    const Certificate p = certified(profile, {20, 44100});
    ASSERT_EQ(p.entries.back().doubled, "points");
    EXPECT_EQ(p.entries.back().options, (Certificate::Options{{"nodes", "64"}}));
    const auto nut = [&profile](const char* nodes) {
        return run(exact_contact, profile, {0, 44100, 20, {{"nodes", nodes}}}).trace;
    };
    const Trace points = nut("32"), more = nut("64");
    EXPECT_DOUBLE_EQ(p.pairs.back().taps[0].relative_l2.back(),
                     relative_difference(more.column(0), points.column(0), 44100, 1));
    EXPECT_GT(p.pairs.back().taps[0].relative_l2.back(), 0);
}

TEST(Certificate, OfASceneThatNoReferenceRepresentsIsTheStandInsOwnEstimate) {
    Scene scene = read_scene("sitar_c5_two_planes", {});
    scene.duration = 1e-3;
    ASSERT_EQ(best_reference(scene), nullptr);
    const Certificate c = certified(scene, {38, 44100});
    ASSERT_EQ(c.entries.size(), 1u);
    EXPECT_EQ(c.entries[0].sample_rate, 64 * 44100.0);
    EXPECT_EQ(c.entries[0].reference.find("oversampled "), 0u);
    EXPECT_EQ(c.entries[0].estimate.size(), scene.taps.size());
    EXPECT_TRUE(c.pairs.empty());
    EXPECT_EQ(c.floor.size(), scene.taps.size());
}

TEST(Certificate, OfALinearSceneRestsOnTheClosedForm) {
    Scene scene = c3_free();
    scene.strings.front().start = ModeShape{2, 1e-3};
    scene.duration = 20e-3;
    const Certificate c = certified(scene, {30, 44100});
    EXPECT_EQ(c.entries.front().reference, "exact_linear");
    EXPECT_EQ(c.entries.size(), 5u);
    for (const auto& pair : c.pairs)  // one mode swings: twice as many change nothing
        for (const Agreement& tap : pair.taps) EXPECT_LT(tap.relative_l2.back(), 1e-12);
}

}  // namespace
}  // namespace jvari::test
