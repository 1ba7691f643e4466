// What references are certified by: agreement of two traces, and Richardson's estimate of a
// scheme's own error.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "reference/agreement.hpp"
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
            const double estimate = o.estimates[k].back();
            const double error =
                relative_difference(o.run.trace.column(k), truth.trace.column(k), 44100, 1);
            EXPECT_LT(error, estimate) << "x" << multiple << " " << truth.trace.names[k];
            if (multiple >= 32) {
                EXPECT_GT(error, 0.02 * estimate) << "x" << multiple << " " << truth.trace.names[k];
            }
        }
    }
}

// of the grids, for two strings: each string is the exact one's
TEST(StandIn, IsTheSchemeThatErrsLeastAndSaysSoItself) {
    Scene one = c3_free();
    one.duration = 10e-3;
    one.strings.front().start = ModeShape{4, 1e-3};
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
    scene.strings.front().start = TriangleShape{0.3, 1e-3, 0.3};
    scene.strings.front().bending_stiffness = 0;
    scene.duration = 5e-3;
    const auto estimate = [&](int multiple) {
        return oversampled(scheme("finite_difference_hamiltonian"), scene, {44100, 44100, 0, {}},
                           multiple)
            .estimates[1]
            .back();
    };
    EXPECT_NEAR(std::log2(estimate(8) / estimate(16)), 2, 0.3);
}

TEST(Oversampled, RefusesMultiplesThatDoNotHalveTwice) {
    EXPECT_THROW(oversampled(scheme("modal_two_point"), release(1e-3), {44100, 44100, 10, {}}, 6),
                 Refusal);
    EXPECT_THROW(oversampled(scheme("modal_two_point"), release(1e-3), {44100, 44100, 10, {}}, 2),
                 Refusal);
}

}  // namespace
}  // namespace jvari
