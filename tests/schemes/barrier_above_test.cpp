// A barrier above the string: the mirror image of one below, alone and as one of two.
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

const std::vector<std::string> takes_one_above{"modal_two_point",
                                               "modal_two_point compliance=matched",
                                               "modal_three_point",
                                               "modal_three_point compliance=matched",
                                               "modal_two_moment",
                                               "modal_quadratised",
                                               "finite_difference_theta",
                                               "finite_difference_theta compliance=matched",
                                               "finite_difference_hamiltonian",
                                               "exact_contact",
                                               "exact_contact compliance=matched",
                                               "sundials"};

Settings sampled() { return {44100, 44100, 40, {}}; }

LumpedBarrier stop(Side side, double x, double height) {
    LumpedBarrier b;
    b.position = x, b.width = 4e-3, b.height = height, b.stiffness.k = 1e6, b.side = side;
    return b;
}

// with a thread, a loss and a pluck, so that signs of all products count
Scene over(std::vector<Barrier> barriers, double way) {
    Scene scene = lasting(c3_release(), 0.02);
    String& s = scene.strings[0];
    s.barriers = std::move(barriers);
    s.thread->height = way * 1e-5;
    s.start = ModeShape{1, way * 1e-3};
    return scene;
}

void expect_opposite(const Scene& one, const Scene& other, const std::string& form) {
    const auto a = play(form, one, sampled(), {.energy = true}),
               b = play(form, other, sampled(), {.energy = true});
    ASSERT_EQ(a.status.outcome, Outcome::ok) << form;
    EXPECT_GT(largest(a.trace.column(2)), 0.1) << form;  // it is touched
    for (int k = 0; k < 4; ++k) {
        double most = 0;
        for (long n = 0; n < a.trace.rows; ++n)
            most = std::max(most, std::abs(a.trace.column(k)[n] + b.trace.column(k)[n]));
        const double exact = form.starts_with("exact") || form == "sundials" ? 1e-7 : 1e-13;
        EXPECT_LE(most, exact * largest(a.trace.column(k))) << form << " " << k;
    }
    if (!form.starts_with("exact") && form != "sundials") {
        EXPECT_LT(ledger(a.trace).row, 1e-11) << form;
    }
}

TEST(BarrierAbove, IsTheMirrorImageOfOneBelow) {
    for (const std::string& form : takes_one_above) {
        expect_opposite(over({stop(Side::above, 0.3, 2e-4)}, 1),
                        over({stop(Side::below, 0.3, -2e-4)}, -1), form);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(BarrierAbove, WithOneBelowIsAGuideThatMirrorsItself) {
    const std::vector<Barrier> guide{stop(Side::below, 0.3, -2e-4), stop(Side::above, 0.3, 2e-4)},
        turned{stop(Side::above, 0.3, 2e-4), stop(Side::below, 0.3, -2e-4)};
    for (const std::string& form : takes_one_above) {
        if (form.find("matched") != std::string::npos) continue;  // two contacts in one place
        expect_opposite(over(guide, 1), over(turned, -1), form);
    }
    const auto r = play("exact_contact", over(guide, 1), sampled());
    double most = 0, least = 0;  // both stops push, each in its way
    for (const double F : r.trace.column(2)) most = std::max(most, F), least = std::min(least, F);
    EXPECT_GT(most, 0.1);
    EXPECT_LT(least, -0.1);
}

TEST(BarrierAbove, PressesAStringAtRestDown) {
    Scene above = over({stop(Side::above, 0.3, -1e-4)}, 1),
          below = over({stop(Side::below, 0.3, 1e-4)}, -1);
    for (Scene* s : {&above, &below})
        s->strings[0].start = RestStart{}, s->strings[0].thread->height = 0;
    for (const char* form :
         {"modal_two_point", "exact_contact", "modal_two_point compliance=matched"}) {
        const auto a = play(form, above, sampled()), b = play(form, below, sampled());
        EXPECT_LT(a.trace.column(2).back(), -1e-3) << form;
        EXPECT_NEAR(a.trace.column(1).back(), -b.trace.column(1).back(), 1e-15) << form;
        EXPECT_NEAR(a.trace.column(1).back(), a.trace.column(1)[0], 1e-12) << form;
    }
}

TEST(BarrierAbove, IsRefusedByWhatHasNone) {
    const Scene scene = over({stop(Side::above, 0.3, 2e-4)}, 1);
    for (const char* form : {"modal_spatial_newton", "modal_explicit_penalty",
                             "modal_generalised_alpha", "modal_moreau_jean"})
        EXPECT_TRUE(says(refusal(form, scene, sampled()), "barrier above the string")) << form;
}

}  // namespace
}  // namespace jvari
