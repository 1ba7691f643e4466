// A mass with a weight, on a spring and a damper: its own motion in closed form, its momentum and
// its energy against the rows of its force, the exact contact, and rest under the weight.
#include <complex>

#include "scenes/modes.hpp"
#include "schemes/impacts.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

const std::vector<std::string> forms{"modal_two_point",
                                     "modal_two_point compliance=matched",
                                     "modal_two_point_trapezoidal",
                                     "modal_three_point",
                                     "modal_quadratised",
                                     "modal_quadratised levels=3",
                                     "finite_difference_explicit",
                                     "finite_difference_theta",
                                     "finite_difference_hamiltonian"};

Settings sampled(double rate, int modes) { return {rate, 44100, modes, {}}; }

Scene with(const Mass& mass, double seconds) {
    Scene scene = lasting(c3_free(), seconds);
    scene.strings[0].masses = {mass};
    scene.taps = taps_beside_a_mass(0.3);
    return scene;
}
// 5 g that touch nothing within 20 ms
Mass apart_from_all() {
    Mass m;
    m.mass = 5e-3, m.position = 0.4, m.stiffness = 1e4, m.gap = 1;
    return m;
}

TEST(JoinedMass, SwingsAndFallsByItselfAsAClosedFormSays) {
    for (const double damping : {0.0, 0.2, 4.0, 8.0}) {  // critical: 2 sqrt(k M) = 2
        Mass m = apart_from_all();
        m.spring = 200, m.damping = damping, m.velocity = 0.5, m.weight = 0.05;
        const std::complex<double> s = 0.5 * damping / m.mass, w0 = std::sqrt(m.spring / m.mass),
                                   root = std::sqrt(s * s - w0 * w0), a = -s + root, b = -s - root;
        const double rest = -1 + 0.05 / 200, from = -0.05 / 200;
        for (const std::string& form : forms) {
            const auto r = play(form, with(m, 0.02), sampled(44100, 60));
            // two-point steps start with a lead of the phase, of the order (omega dt)^2
            const double near = form.find("three") < form.size() ||
                                        form.find("levels=3") < form.size() ||
                                        form.ends_with("explicit") || form.ends_with("theta")
                                    ? 1e-9
                                    : 1e-4;
            for (long n = 0; n < r.trace.rows; n += 7) {
                const double t = n / 44100.0;
                const std::complex<double> A = (0.5 - b * from) / (a - b), B = from - A;
                const double x = (A * std::exp(a * t) + B * std::exp(b * t)).real();
                ASSERT_NEAR(r.trace.column(1)[n], rest + x, near * 0.01) << form << damping << n;
            }
        }
        const auto r = play("exact_contact", with(m, 0.02), sampled(44100, 60));
        const std::complex<double> A = (0.5 - b * from) / (a - b), B = from - A;
        for (long n = 0; n < r.trace.rows; ++n) {
            const double t = n / 44100.0;
            const auto x = A * std::exp(a * t) + B * std::exp(b * t),
                       v = a * A * std::exp(a * t) + b * B * std::exp(b * t);
            ASSERT_NEAR(r.trace.column(1)[n], rest + x.real(), 1e-13) << damping << n;
            ASSERT_NEAR(r.trace.column(2)[n], v.real(), 1e-12) << damping << n;
        }
    }
    Mass falls = apart_from_all();
    falls.weight = 0.05, falls.velocity = -0.1;  // 10 m/s^2
    auto all = forms;
    all.insert(all.end(), {"exact_contact", "sundials"});
    for (const std::string& form : all) {
        const auto r = play(form, with(falls, 0.02), sampled(44100, 60));
        for (long n = 0; n < r.trace.rows; ++n) {
            const double t = n / 44100.0;
            ASSERT_NEAR(r.trace.column(1)[n], -1 - 0.1 * t + 5 * t * t, 1e-13) << form << n;
            ASSERT_NEAR(r.trace.column(2)[n], -0.1 + 10 * t, 1e-11) << form << n;
        }
    }
}

TEST(JoinedMass, FallsOnTheStringAtTheSquareRootOfItsWay) {
    Mass m = apart_from_all();
    m.gap = 1e-3, m.weight = 0.05;
    for (const auto& [form, instant] : {std::pair{"exact_contact", 1e-9},
                                        {"modal_two_point", 5e-5},
                                        {"modal_three_point", 5e-5}}) {
        const Scene scene = with(m, 0.03);
        std::vector<Impacts> restituted(scene.strings.begin(), scene.strings.end());
        RunOptions how;
        how.impacts = restituted.data();
        play(form, scene, sampled(44100, 40), how);
        ASSERT_FALSE(restituted[0].all().empty()) << form;
        EXPECT_NEAR(restituted[0].all()[0].start, std::sqrt(2 * 1e-3 / 10), instant) << form;
        EXPECT_NEAR(restituted[0].all()[0].speed_in, std::sqrt(2 * 1e-3 * 10), 20 * instant)
            << form;
    }
}

// A ring of 0.2 g that lies on a string.
Scene ring(bool joined, double seconds) {
    Mass m;
    m.mass = 2e-4, m.position = 0.4, m.stiffness = 1e5, m.weight = 0.05;
    if (joined) m.spring = 300, m.damping = 0.02;
    Scene scene = with(m, seconds);
    scene.strings[0].start = ModeShape{1, 1e-3};
    return scene;
}

TEST(JoinedMass, TradesMomentumAndEnergyWithoutLoss) {
    for (const bool joined : {false, true})
        for (const std::string& form : forms) {
            Scene scene = ring(joined, 0.02);
            scene.strings[0].damping = NoDamping{};
            const auto r = play(form, scene, sampled(44100, 60), {.energy = true});
            ASSERT_EQ(r.status.outcome, Outcome::ok) << form;
            EXPECT_GT(largest(r.trace.column(3)), 0.2) << form;
            const Ledger l = ledger(r.trace);
            EXPECT_LT(l.row, 1e-12) << form << joined;
            EXPECT_LT(l.sum, 1e-11) << form << joined;
            if (form.find("matched") == std::string::npos) {  // the series compliance radiates
                EXPECT_EQ(l.lost > 1e-4, joined) << form << l.lost;
            }
            double impulse = 0;
            for (long n = 1; n < r.trace.rows && !joined; ++n) {
                impulse += (0.05 - r.trace.column(3)[n]) / 44100;
                ASSERT_NEAR(2e-4 * r.trace.column(2)[n], impulse, 1e-14) << form << n;
            }
        }
    for (const bool joined : {false, true}) {
        const auto r =
            play("exact_contact", ring(joined, 0.02), sampled(44100, 60), {.energy = true});
        EXPECT_LT(ledger(r.trace).row, 1e-9) << joined;
    }
}

TEST(JoinedMass, RattlesAsTheExactContactSays) {
    for (const bool joined : {false, true}) {
        const Scene scene = ring(joined, 6e-3);
        const auto exact = play("exact_contact", scene, sampled(44100, 30));
        EXPECT_GT(fact(exact, "events"), 3);
        for (int k = 0; k < 3 && !joined; ++k)
            EXPECT_LT(apart(play("sundials", scene, sampled(44100, 30)), exact, k), 1e-8) << k;
        for (const char* form : {"modal_quadratised", "modal_quadratised levels=3"})
            EXPECT_LT(apart(play(form, scene, sampled(16 * 44100, 30)), exact, 1), 2e-2) << form;
        for (const char* form : {"modal_two_point", "modal_three_point"}) {
            const double coarse = apart(play(form, scene, sampled(4 * 44100, 30)), exact, 1),
                         fine = apart(play(form, scene, sampled(16 * 44100, 30)), exact, 1);
            EXPECT_LT(fine, 0.15 * coarse) << form << joined;
            EXPECT_LT(fine, 2e-3) << form << joined;
        }
    }
}

// In the end the string carries the weight: it sags by its own compliance.
TEST(JoinedMass, ComesToRestOnTheString) {
    Scene scene = ring(false, 2);
    String& s = scene.strings[0];
    s.start.reset();
    s.damping = PolynomialDamping{30, 0, 0};
    s.masses[0].contact_loss = 20;
    scene.taps[0].position = 0.4;
    const auto r = play("modal_two_point", scene, sampled(44100, 40));
    const Modes m = modes_of(s, 40);
    const double sag = 0.05 * static_compliance(m, displacement_weights(m, 0.4));
    EXPECT_NEAR(r.trace.column(3).back(), 0.05, 1e-5);
    EXPECT_NEAR(r.trace.column(0).back(), sag, 1e-3 * sag);
    EXPECT_NEAR(r.trace.column(1).back(), sag + 0.05 / 1e5, 1e-3 * sag);
    EXPECT_NEAR(r.trace.column(2).back(), 0, 1e-5);
}

TEST(JoinedMass, IsRefusedByWhatHasNone) {
    for (const char* form : {"modal_two_moment", "modal_spatial_newton"}) {
        EXPECT_TRUE(says(refusal(form, ring(false, 1), sampled(44100, 10)), "mass with a weight"));
        EXPECT_TRUE(
            says(refusal(form, ring(true, 1), sampled(44100, 10)), "mass on a spring or damper"));
    }
    EXPECT_TRUE(says(refusal("sundials", ring(true, 1), sampled(44100, 10)), "mass on a spring"));
}

}  // namespace
}  // namespace jvari
