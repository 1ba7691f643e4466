// Contact loss that does not pull: the two references and the gradient rule against one another,
// where the law of Hunt and Crossley pulls.
#include "scenes/scene_file.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

const Settings audio{44100, 44100, 40, {}};

// soft, and so lossy that the string leaves faster than 1/beta
Scene pulling(LossLaw law, int barriers = 1) {
    Scene scene = lasting(read_scene("tanpura_c3_release"), 0.015);
    String& s = scene.strings[0];
    s.thread.reset();
    s.barriers.clear();
    for (int k = 0; k < barriers; ++k)
        s.barriers.emplace_back(LumpedBarrier{(0.1 + 0.05 * k) * s.length,
                                              0.04 * s.length,
                                              -3e-4 - 1e-4 * k,
                                              {2e4},
                                              1 + 0.5 * k,
                                              20,
                                              law});
    s.damping = NoDamping{};
    scene.taps = {{"push", Quantity::bridge_force, 0, 0}, {"nut", Quantity::nut_force, 0, 0}};
    return scene;
}
double least(const Run& r) {
    const auto rows = r.trace.column(0);
    return *std::min_element(rows.begin(), rows.end());
}

TEST(ClippedLoss, NeverPullsWhereHuntAndCrossleyDo) {
    for (const int barriers : {1, 3})
        for (const char* form :
             {"exact_contact", "sundials", "sundials flight=integrate", "modal_two_point"}) {
            const auto pulls = play(form, pulling(LossLaw::hunt_crossley, barriers), audio),
                       clipped = play(form, pulling(LossLaw::clipped, barriers), audio);
            ASSERT_EQ(clipped.status.outcome, Outcome::ok) << form << barriers;
            EXPECT_LT(least(pulls), -1e-3 * largest(pulls.trace.column(0))) << form << barriers;
            EXPECT_LT(fact(pulls, "smallest_contact_force"), -1e-3) << form;
            EXPECT_GE(least(clipped), 0) << form << barriers;
            EXPECT_GE(fact(clipped, "smallest_contact_force"), 0) << form;
            EXPECT_GT(apart(pulls, clipped, 0), 1e-3) << form << barriers;
        }
}

TEST(ClippedLoss, TheReferencesAgreeAndTheSchemeConvergesToThem) {
    for (const int barriers : {1, 3}) {
        const Scene scene = pulling(LossLaw::clipped, barriers);
        const auto exact = play("exact_contact", scene, audio),
                   integrated = play("sundials", scene, audio),
                   flying = play("sundials flight=integrate", scene, audio);
        for (const int tap : {0, 1}) {
            EXPECT_LT(apart(integrated, exact, tap), 1e-9) << barriers;
            EXPECT_LT(apart(flying, exact, tap), 1e-9) << barriers;
        }
        Settings fine = audio;
        fine.sample_rate = 705600;
        const double at_once = apart(play("modal_two_point", scene, audio), exact, 1),
                     in_the_end = apart(play("modal_two_point", scene, fine), exact, 1);
        EXPECT_LT(in_the_end, 1e-2) << barriers;
        EXPECT_LT(in_the_end, 0.2 * at_once) << barriers;
    }
}

TEST(ClippedLoss, BalancesWithWhatItLoses) {
    RunOptions probed;
    probed.energy = true;
    for (const int barriers : {1, 3})
        for (const auto& [form, open] :
             {std::pair{"exact_contact", 1e-9}, {"sundials", 1e-9}, {"modal_two_point", 1e-12}}) {
            const Ledger l =
                ledger(play(form, pulling(LossLaw::clipped, barriers), audio, probed).trace);
            EXPECT_LT(l.sum, open) << form << barriers;
            EXPECT_GT(l.lost, 0.01) << form << barriers;
            EXPECT_GE(l.least_loss, -1e-12) << form << barriers;
        }
}

TEST(ClippedLoss, OnAMovingBodyTheReferenceAndTheSchemeAgree) {
    Scene scene = lasting(pulling(LossLaw::clipped), 0.01);
    scene.body = Body{"", "", {{0.02, 2.5e4, 0.5}}};
    RunOptions probed;
    probed.energy = true;
    const auto exact = play("sundials", scene, audio, probed);
    EXPECT_GE(least(exact), 0);
    EXPECT_LT(ledger(exact.trace).sum, 1e-9);
    Settings fine = audio;
    fine.sample_rate = 352800;
    const auto run = play("modal_two_point", scene, fine, probed);
    EXPECT_LT(apart(run, exact, 1), 1e-2);
    EXPECT_LT(ledger(run.trace).sum, 1e-12);
}

TEST(ClippedLoss, IsRefusedByItsNameWhereASchemeDoesNotTakeIt) {
    for (const char* form : {"modal_quadratised", "finite_difference_theta", "modal_three_point",
                             "modal_two_point_trapezoidal", "modal_two_point_penalty"})
        EXPECT_TRUE(says(refusal(form, pulling(LossLaw::clipped), audio),
                         "contact loss that does not pull"))
            << form;
}

}  // namespace
}  // namespace jvari
