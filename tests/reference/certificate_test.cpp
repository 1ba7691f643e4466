// What references are certified by: agreement of two traces, Richardson's estimate of a scheme's
// own error, the table over all references.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "reference/certificate.hpp"
#include "reference/oversampled.hpp"
#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

const Descriptor& scheme(std::string_view name) {
    for (const Descriptor& d : schemes())
        if (name == d.name) return d;
    throw std::runtime_error("no such scheme");
}

// A sine of 1 V and a difference that grows tenfold every 100 rows: sum d^2 = d_n^2/(1 - 10^-0.02)
// = 22.2 d_n^2, against n/2.
TEST(Agreement, EndsWhereTheRunningDifferencePassesTheLevel) {
    const double rate = 1000;
    std::vector<double> a, b;
    for (int n = 0; n <= 1000; ++n) {
        b.push_back(std::sin(0.3 * n));
        a.push_back(b.back() + 1e-10 * std::pow(10, n / 100.0));
    }
    const Agreement g = agreement(a, b, rate);
    for (int l = 0; l < 3; ++l) {
        const double n = 1000 * g.until[l];
        EXPECT_NEAR(std::sqrt(22.2 / (n / 2)) * 1e-10 * std::pow(10, n / 100), agreement_levels[l],
                    0.05 * agreement_levels[l]);
    }
    EXPECT_NEAR(g.relative_l2.back(), std::sqrt(22.2 / 500), 0.01 * g.relative_l2.back());
    EXPECT_LT(g.relative_l2[0], 1e-9);
}

TEST(Agreement, OfEqualTracesIsWholeAndOfSilenceIsNoDivisionByZero) {
    const std::vector<double> zero(50, 0.0), one(50, 1.0);
    const Agreement g = agreement(one, one, 100);
    EXPECT_EQ(g.relative_l2.back(), 0);
    EXPECT_EQ(g.until[2], 0.49);
    EXPECT_EQ(agreement(zero, zero, 100).relative_l2.back(), 0);
    EXPECT_EQ(agreement(zero, zero, 100).until[0], 0.49);
    EXPECT_EQ(agreement(one, zero, 100).until[0], 0);
}

Scene release(double duration) {
    Scene scene = c3_release();
    scene.duration = duration;
    return scene;
}

TEST(Oversampled, EstimatesNoLessThanItsErrorAgainstTheExactReference) {
    const Scene scene = release(20e-3);
    const auto truth = run(exact_contact, scene, {0, 44100, 60, {}});
    for (const int multiple : {8, 16, 32, 64}) {
        const Oversampled o =
            oversampled(scheme("modal_two_point"), scene, {44100, 44100, 60, {}}, multiple);
        EXPECT_EQ(o.rate, 44100.0 * multiple);
        for (int k = 0; k < truth.trace.taps(); ++k) {
            const auto& whole = o.estimates[k].back();
            const double error =
                relative_difference(o.run.trace.column(k), truth.trace.column(k), 44100, 1);
            EXPECT_LT(error, whole.error) << "x" << multiple << " " << truth.trace.names[k];
            if (multiple >= 32) {
                EXPECT_GT(error, 0.02 * whole.error)
                    << "x" << multiple << " " << truth.trace.names[k];
            }
        }
    }
}

// of the grids, for two strings: each string is the exact one's
TEST(StandIn, IsTheSchemeThatErrsLeastAndSaysSoItself) {
    Scene one = c3_free();
    one.duration = 10e-3;
    one.strings.front().initial = ModeInitial{4, 1e-3};
    one.taps = {{"nut", Quantity::nut_force, {}, 0}};
    Scene two = one;
    two.strings.push_back(two.strings.front());
    const std::vector<const Descriptor*> able{&scheme("finite_difference_explicit"),
                                              &scheme("finite_difference_theta"),
                                              &scheme("finite_difference_hamiltonian")};
    const Settings coarsest{44100, 44100, 0, {}};
    const Descriptor* best = best_by_estimate(able, two, coarsest, 4);
    ASSERT_NE(best, nullptr);
    const auto truth = run(exact_linear, one, {0, 44100, 133, {}});
    std::vector<double> twice;
    for (const double v : truth.trace.column(0)) twice.push_back(2 * v);
    const auto error = [&](const Descriptor& d) {
        return relative_difference(oversampled(d, two, coarsest, 4).run.trace.column(0), twice,
                                   44100, 1);
    };
    const double chosen = error(*best);
    for (const Descriptor* d : able)
        EXPECT_LE(chosen, error(*d)) << d->name << " errs less than " << best->name;
    EXPECT_NE(best, able.front());
}

TEST(StandIn, OfOneStringCarriesItsModes) {
    const auto able = stand_ins(c3_release());
    ASSERT_EQ(able.size(), 1u);
    EXPECT_STREQ(able.front()->name, "modal_spatial_newton");
    EXPECT_EQ(best_by_estimate({}, c3_release(), {44100, 44100, 0, {}}, 4), nullptr);
}

// a grid's dispersion is of second order
TEST(Oversampled, SeesTheSchemesOrderWhereThereIsNoContact) {
    Scene scene = lossless(c3_free());
    scene.strings.front().initial = TriangleInitial{0.3, 1e-3, 0.3};
    scene.strings.front().bending_stiffness = 0;
    scene.duration = 5e-3;
    const Oversampled o =
        oversampled(scheme("finite_difference_hamiltonian"), scene, {44100, 44100, 0, {}}, 16);
    EXPECT_NEAR(o.estimates[1].back().order, 2, 0.3);
}

TEST(Oversampled, RefusesMultiplesThatDoNotHalveTwice) {
    EXPECT_THROW(oversampled(scheme("modal_two_point"), release(1e-3), {44100, 44100, 10, {}}, 6),
                 Refusal);
    EXPECT_THROW(oversampled(scheme("modal_two_point"), release(1e-3), {44100, 44100, 10, {}}, 2),
                 Refusal);
}

const Certificate::Options matched_alone{{"compliance", "matched"}};

TEST(Certificate, ShowsThatTheReferencesAgree) {
    CertifySettings settings{40, 44100, {}};
    int announced = 0;
    settings.progress = [&](const std::string&, int done, int of) {
        EXPECT_EQ(done, announced++);
        EXPECT_EQ(of, 7);
    };
    const Certificate c = certify(release(6e-3), settings);
    EXPECT_EQ(announced, 7);
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
    const Certificate c = certify(scene, {60, 44100, {}, {}});
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
    const Certificate p = certify(profile, {20, 44100, {}, {}});
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
    const Certificate c = certify(scene, {38, 44100, {}, {}});
    ASSERT_EQ(c.entries.size(), 1u);
    EXPECT_EQ(c.entries[0].sample_rate, 64 * 44100.0);
    EXPECT_EQ(c.entries[0].reference.find("oversampled "), 0u);
    EXPECT_EQ(c.entries[0].estimate.size(), scene.taps.size());
    EXPECT_TRUE(c.pairs.empty());
    EXPECT_EQ(c.floor.size(), scene.taps.size());
}

TEST(Certificate, OfALinearSceneRestsOnTheClosedForm) {
    Scene scene = c3_free();
    scene.strings.front().initial = ModeInitial{2, 1e-3};
    scene.duration = 20e-3;
    const Certificate c = certify(scene, {30, 44100, {}, {}});
    EXPECT_EQ(c.entries.front().reference, "exact_linear");
    EXPECT_EQ(c.entries.size(), 5u);
    for (const auto& pair : c.pairs)  // one mode swings: twice as many change nothing
        for (const Agreement& tap : pair.taps) EXPECT_LT(tap.relative_l2.back(), 1e-12);
}

}  // namespace
}  // namespace jvari
