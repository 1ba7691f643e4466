// Contacts by pieces of a quadratic potential, and the cures of psi, against what they must be equal to.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scene_file.hpp"
#include "schemes/contact/piecewise_rule.hpp"
#include "schemes/contact/quadratised_rule.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/schemes/contact_points.hpp"

namespace jvari {
namespace {

// With exponent 1 there is nothing to be replaced; with others force and increment are the discrete gradient's to the tolerance.
TEST(Piecewise, IsTheDiscreteGradientOfItsPotential) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const double alpha : {1.0, 1.3, 1.5, 2.0, 3.0})
        for (const double tolerance : {1e-2, 1e-4}) {
            const ContactLaw law{1e5 * std::pow(1e-5, 1 - alpha), alpha};
            const PiecewiseLaw pieces(law, tolerance);
            for (int draw = 0; draw < 2000; ++draw) {
                const double eta = unit(random) * std::pow(10, -4 + 2 * unit(random)),
                             b = unit(random) * std::pow(10, -4 + 2 * unit(random)), theta = std::pow(10, -5 + 3 * unit(random));
                const ContactSolution got = pieces.solve(eta, b, theta), want = solve_contact(law, eta, b, theta);
                const double size = std::abs(eta) + std::abs(b), work = pieces.potential(eta) - pieces.potential(eta - got.r);
                EXPECT_GE(got.force, 0);
                EXPECT_NEAR(got.r, -b + theta * got.force, 1e-10 * size) << alpha << " " << eta << " " << b << " " << theta;
                EXPECT_NEAR(got.force * got.r, work, 1e-10 * (pieces.potential(eta) + pieces.potential(eta - got.r) + 1e-30)) << alpha;
                EXPECT_NEAR(got.r, want.r, 2 * (alpha == 1 ? 1e-10 : tolerance) * (size + std::abs(want.r))) << alpha;
            }
            EXPECT_LE(pieces.misfit(), tolerance);
        }
}

TEST(Piecewise, SeveralContactsAreSolvedTogether) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int draw = 0; draw < 100; ++draw) {
        Points p;
        for (int a = 0; a < 3; ++a) p.contacts.add({1e8, 1.5}, 0, 0);
        couple(p, random, 1e-3);
        PiecewiseRule rule(p.contacts.laws, p.theta, 1);
        double eta[3], b[3], r[3], F[3];
        for (int a = 0; a < 3; ++a) eta[a] = 1e-5 * unit(random), b[a] = 1e-5 * unit(random);
        ASSERT_TRUE(rule.solve({eta, eta, b}, r, F).converged);
        double work = 0, stored = 0;
        for (int a = 0; a < 3; ++a) {
            work += F[a] * r[a];
            stored += rule.potential(a, eta[a]) - rule.potential(a, eta[a] - r[a]);
            double moved = -b[a];
            for (int c = 0; c < 3; ++c) moved += p.theta[a * 3 + c] * F[c];
            EXPECT_NEAR(r[a], moved, 1e-17);
        }
        EXPECT_NEAR(work, stored, 1e-9 * (std::abs(work) + 1e-12));
    }
}

jvari::Run cured(const char* variant, const char* levels, const char* lambda0, double rate) {
    for (const Descriptor& d : schemes())
        if (d.name == std::string("modal_quadratised")) {
            const Scene scene = read_scene("two_point_bridge", {"string.0.damping.law=none", "duration=0.003"});
            const Settings s{rate, 44100, 40, {{"variant", variant}, {"levels", levels}, {"lambda0", lambda0}}};
            return jvari::run(d, scene, s, {.energy = true});
        }
    throw Refusal("no scheme");
}
double fact(const jvari::Run& r, const char* name) {
    for (const Fact& f : r.facts)
        if (f.name == name) return f.value;
    return NAN;
}

TEST(CuresOfPsi, KeepTheirLedgerAndOnlyRelaxationLoses) {
    for (const char* levels : {"2", "3"})
        for (const char* variant : {"raw", "constrained", "released", "relaxed", "controlled"}) {
            const jvari::Run r = cured(variant, levels, "1e5", 352800);
            double worst = 0, lost = 0, least = 0;
            const auto stored = r.trace.energy_column(0), spent = r.trace.energy_column(2);
            for (long i = 1; i < r.trace.rows; ++i) {
                worst = std::max(worst, std::abs(stored[i] - stored[i - 1] + spent[i]));
                lost += spent[i];
                least = std::min(least, spent[i]);
            }
            EXPECT_LT(worst / stored[0], 1e-11) << variant << levels;
            EXPECT_GE(least / stored[0], -1e-12) << variant << levels;
            if (variant == std::string("relaxed")) EXPECT_GT(lost / stored[0], 1e-6) << levels;
            else EXPECT_LT(std::abs(lost) / stored[0], 1e-11) << variant << levels;
        }
}

TEST(CuresOfPsi, RelaxationLeavesNoPsiBehindAndControlOfZeroIsRaw) {
    for (const char* levels : {"2", "3"}) {
        EXPECT_EQ(fact(cured("relaxed", levels, "0", 352800), "psi_out_of_contact"), 0) << levels;
        const double raw = fact(cured("raw", levels, "0", 352800), "psi_gap");
        EXPECT_GT(raw, 0.5) << levels;
        EXPECT_NEAR(fact(cured("controlled", levels, "0", 352800), "psi_gap"), raw, 1e-6 * raw) << levels;
    }
}

// Where a force hardly moves the point psi falls by lambda0 dt of itself in each step out of contact.
TEST(CuresOfPsi, ControlDrawsPsiBackAtItsRate) {
    const ContactLaw law{1e6, 1.5};
    const double theta = 1e-20, rate = 1e5, lambda0 = 1e4;
    for (const int levels : {1, 2}) {
        QuadratisedContacts rule(std::span(&law, 1), std::span(&theta, 1), levels, Quadratisation::controlled);
        rule.choose({rate, rate, 1, {{"lambda0", std::to_string(lambda0)}}});
        const double inside = 1e-5;
        rule.begin(&inside);
        const double start = rule.potential(0, 0);
        for (int step = 1; step <= 20; ++step) {
            const double out = -1e-5 * step, b = -2e-6;
            double r, F;
            rule.solve({&out, &out, &b}, &r, &F);
            EXPECT_NEAR(rule.potential(0, 0) / start, std::pow(1 - lambda0 / rate, 2 * step), 1e-9) << levels << " " << step;
        }
    }
}

}  // namespace
}  // namespace jvari
