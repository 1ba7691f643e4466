// Quadratised contact: the released variant pushes only and leaves nothing behind, the raw one does
// neither. That its own energy is balanced proves nothing (ledger_test).
#include "schemes/contact/quadratised_contact.hpp"

#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

const std::string two = "modal_quadratised", three = "modal_quadratised levels=3";

TEST(Quadratised, ReleasedNeverPullsNorKeepsPsiOutOfContactAndRawIsFlagged) {
    for (const std::string& form : {two, three})
        for (const Scene& scene : {c3_release(), c3_pluck(), with_exponent(c3_pluck(), 2.3)}) {
            const auto r = play(form, lasting(scene, 0.03), {4 * 44100, 44100, 133, {}});
            EXPECT_EQ(fact(r, "smallest_contact_force"), 0) << form;
            EXPECT_EQ(fact(r, "psi_out_of_contact"), 0) << form;
            EXPECT_GT(fact(r, "deepest_penetration"), 0) << form;
            for (const double f : r.trace.column(2)) ASSERT_GE(f, 0) << form;
        }
    for (const std::string& form : {two, three}) {
        const auto r =
            play(form + " variant=raw", lasting(c3_release(), 0.02), {64 * 44100, 44100, 133, {}});
        EXPECT_LT(fact(r, "smallest_contact_force"), -0.1) << form;  // N: adhesion
        EXPECT_GT(fact(r, "psi_gap"), 0.5) << form;
        EXPECT_GT(fact(r, "psi_out_of_contact"), 0.1) << form;
    }
}

TEST(Quadratised, ReleasedNeverPullsOnSeveralPointsAndRawDoes) {
    Scene two_bridges = lasting(read_scene("two_point_bridge"), 0.02);
    two_bridges.strings[0].barriers.push_back(two_bridges.strings[0].barriers[0]);
    barrier(two_bridges, 1).position = 14e-3;
    for (const Scene& s : {two_bridges, lasting(read_scene("sitar_parabola"), 0.02)}) {
        const Settings settings{128e3, 128e3, 80, {}};
        EXPECT_EQ(fact(play(two, s, settings), "smallest_contact_force"), 0) << s.name;
        EXPECT_LT(fact(play(two + " variant=raw", s, settings), "smallest_contact_force"), -1e-3)
            << s.name;
    }
}

// A soft bed that the string lies in: psi = sqrt(K) eta is linear.
TEST(Quadratised, LastingLinearContactKeepsPsi) {
    Scene scene = lasting(lossless(c3_release()), 1e-3);
    barrier(scene) = {0.2, 2e-3, 1e-2, {50}, 1, 0};
    for (const char* variant : {" variant=released", " variant=raw"}) {
        const auto r = play(two + variant, scene, {44100, 44100, 30, {}}, {.energy = true});
        EXPECT_LT(fact(r, "psi_gap"), 1e-12) << variant;
        EXPECT_LT(fact(r, "energy_gap"), 1e-12 * r.trace.energy_column(0)[0]) << variant;
    }
}

TEST(Quadratised, TheStepSolvesItsEquationsAndReleaseLeavesNothingBehind) {
    for (double alpha : {1.0, 1.5, 3.0})
        for (double c : {0.5, 1.0})
            for (double eta : {-1e-6, 1e-8, 1e-6})
                for (double psi : {1e-9, 1e-5, 1e-3})
                    for (double r0 : {-1e-5, -1e-9, 1e-9, 1e-7, 1e-5})
                        for (Quadratisation variant :
                             {Quadratisation::raw, Quadratisation::released}) {
                            const auto q = QuadratisedLaw::make({4e8, alpha}, variant, c);
                            const double theta = 1e-5;
                            const QuadratisedStep s = solve_quadratised(q, eta, psi, r0, theta);
                            const double r = r0 + theta * s.force, work = s.force * r,
                                         given = c * (psi * psi - s.psi * s.psi);
                            EXPECT_NEAR(work, given,
                                        1e-11 * (c * psi * psi + c * s.psi * s.psi +
                                                 std::abs(s.force * r0)));
                            if (variant != Quadratisation::released) continue;
                            EXPECT_GE(s.force, 0);
                            EXPECT_GE(s.psi, 0);
                            if (eta <= 0) { EXPECT_EQ(s.psi, 0); }
                        }
}

// Ducceschi et al. 2021, with eta^{n+1} - eta^{n-1} = -r
TEST(Quadratised, BothLevelsAreThePublishedFormulae) {
    const double K = 4e8, alpha = 1.5, theta = 1e-5;
    for (double eta : {-1e-6, 1e-6, 2e-5})
        for (double psi : {-2e-4, 3e-5, 1e-3})
            for (double r0 : {-1e-5, 1e-7, 1e-6})
                for (const double weight : {1.0, 0.5}) {  // three-point, two-point
                    const double half = 0.25 / weight;    // 1/4 and 1/2
                    const double g =
                        eta > 0 ? std::sqrt(K * (alpha + 1) / 2) * std::pow(eta, (alpha - 1) / 2)
                                : 0;
                    const double F = (g * psi - half * g * g * r0) / (1 + half * g * g * theta);
                    const QuadratisedStep s = solve_quadratised(
                        QuadratisedLaw::make({K, alpha}, Quadratisation::raw, weight), eta, psi, r0,
                        theta);
                    EXPECT_NEAR(s.force, F, 1e-11 * std::abs(F));
                    EXPECT_NEAR(s.psi, psi - 2 * half * g * (r0 + theta * F),
                                1e-10 * std::abs(psi) + 1e-10 * std::abs(g * r0));
                }
}

// Many points, of which some are at F = 0 and open or close with others
TEST(Quadratised, IsSolvedInEveryStepOverProfiles) {
    struct Case {
        const char *form, *scene;
        double times, seconds;
        int modes;
    };
    for (const auto& [form, name, times, seconds, modes] :
         {Case{"modal_quadratised levels=3", "sitar_parabola", 1, 0.01, 0},
          Case{"modal_quadratised", "sitar_parabola", 1, 0.06, 0},
          Case{"modal_quadratised levels=3", "sitar_c5", 1, 0.03, 0},
          Case{"modal_quadratised", "sitar_c5_raised", 1, 0.03, 0},
          Case{"modal_quadratised compliance=matched", "sitar_c5_raised", 2, 0.07, 80}}) {
        const auto r =
            play(form, lasting(read_scene(name), seconds), {times * 44100, 44100, modes, {}});
        EXPECT_EQ(r.status.outcome, Outcome::ok) << form << ' ' << name << ' ' << r.status.step;
    }
}

}  // namespace
}  // namespace jvari
