// A free mass that meets a string: against the two-degree system of a mass and one mode, its
// momentum against the rows of its force, the ledger, two references, and a mass so heavy that it
// is a barrier.
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/impacts.hpp"
#include "tests/c3.hpp"
#include "tests/claims.hpp"

namespace jvari {
namespace {

using std::numbers::pi;
const std::vector<std::string> forms{"modal_two_moment",
                                     "modal_two_point",
                                     "modal_two_point_trapezoidal",
                                     "modal_three_point",
                                     "modal_spatial_newton",
                                     "modal_quadratised",
                                     "modal_quadratised levels=3",
                                     "finite_difference_explicit",
                                     "finite_difference_theta",
                                     "finite_difference_hamiltonian"};

Settings sampled(double rate, int modes) { return {rate, 44100, modes, {}}; }

Scene with_taps(Scene scene) {
    scene.taps = taps_beside_a_mass(0.3 * scene.strings[0].length);
    return scene;
}

// The first mode, of 0.01 kg and 100 Hz, struck in its middle.
Scene one_mode() {
    Scene scene;
    scene.name = "struck";
    String s;
    s.length = 1;
    s.linear_density = 0.02;
    s.tension = s.linear_density * 200 * 200;
    s.masses = {{5e-3, 0.5, 0, 2, 0, 1e4}};
    scene.strings = {s};
    return with_taps(lasting(scene, 5e-3));
}

// x1 = sqrt(m) q, x2 = sqrt(M) z: x'' = -K x while they touch, then each on its own.
struct Closed {
    double m, M, g, w, k, v, sum, gap, angle, end;
    explicit Closed(const Scene& scene) {
        const String& s = scene.strings[0];
        const Mass& mass = s.masses[0];
        const Modes modes = modes_of(s, 1);
        m = modes.mass, M = mass.mass, g = displacement_weights(modes, mass.position)[0],
        w = modes.omega0[0], k = mass.stiffness, v = mass.velocity;
        const double a = w * w + k * g * g / m, b = -k * g / std::sqrt(m * M), c = k / M;
        sum = 0.5 * (a + c), gap = std::hypot(0.5 * (a - c), b),
        angle = 0.5 * std::atan2(2 * b, a - c);
        double low = 1e-4, high = low;
        while (force(high) > 0) low = high, high *= 1.01;
        for (int i = 0; i < 100; ++i) {
            end = 0.5 * (low + high);
            (force(end) > 0 ? low : high) = end;
        }
    }
    struct At {
        double q, z, dq, dz;
    };
    At touching(double t) const {
        const double fast = std::sqrt(sum + gap), slow = std::sqrt(sum - gap), c = std::cos(angle),
                     s = std::sin(angle), start = std::sqrt(M) * v;
        const double p = s * start * std::sin(fast * t) / fast, dp = s * start * std::cos(fast * t),
                     r = c * start * std::sin(slow * t) / slow, dr = c * start * std::cos(slow * t);
        return {(c * p - s * r) / std::sqrt(m), (s * p + c * r) / std::sqrt(M),
                (c * dp - s * dr) / std::sqrt(m), (s * dp + c * dr) / std::sqrt(M)};
    }
    double force(double t) const {
        const At x = touching(t);
        return k * (x.z - g * x.q);
    }
    At at(double t) const {
        if (t <= end) return touching(t);
        const At x = touching(end);
        const double u = t - end;
        return {x.q * std::cos(w * u) + x.dq * std::sin(w * u) / w, x.z + x.dz * u,
                x.dq * std::cos(w * u) - w * x.q * std::sin(w * u), x.dz};
    }
};

double error(const Run& r, const Closed& truth) {  // of the mass, in velocity
    double most = 0;
    for (long n = 0; n < r.trace.rows; ++n) {
        const auto x = truth.at(n / 44100.0);
        most = std::max({most, std::abs(r.trace.column(2)[n] - x.dz) / truth.v,
                         std::abs(r.trace.column(1)[n] - x.z) / (truth.v * truth.end)});
    }
    return most;
}

TEST(FreeMass, AgainstOneModeHasAClosedForm) {
    const Scene scene = one_mode();
    const Closed truth(scene);
    ASSERT_GT(truth.end, 1e-3);
    ASSERT_LT(truth.end, 4e-3);
    for (const char* form : {"exact_contact", "sundials"}) {
        const auto r = play(form, scene, sampled(44100, 1));
        ASSERT_EQ(r.status.outcome, Outcome::ok) << form;
        EXPECT_LT(error(r, truth), 1e-9) << form;
    }
    for (const char* form : {"modal_two_point", "modal_three_point"}) {
        const double coarse = error(play(form, scene, sampled(44100, 1)), truth),
                     fine = error(play(form, scene, sampled(4 * 44100, 1)), truth);
        EXPECT_LT(coarse, 2e-3) << form;
        EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.2) << form << " " << coarse;
    }
}

Scene hammered(double exponent, double stiffness) {
    Scene scene = c3_release();
    String& s = scene.strings.front();
    s.start.reset();
    s.thread.reset();
    s.barriers.clear();
    s.masses = {{3e-3, 0.12 * s.length, 0.01, 3, 1e-4, stiffness, exponent}};
    return with_taps(lasting(scene, 4e-3));
}

TEST(FreeMass, GivesTheStringTheMomentumThatItLoses) {
    for (const double exponent : {1.0, 2.3})
        for (const std::string& form : forms) {
            Scene scene = hammered(exponent, exponent == 1 ? 2e4 : 1e9);
            scene.strings[0].damping = NoDamping{};
            const auto r = play(form, scene, sampled(44100, 60), {.energy = true});
            ASSERT_EQ(r.status.outcome, Outcome::ok) << form;
            const auto v = r.trace.column(2), F = r.trace.column(3);
            EXPECT_EQ(v[0], 3) << form;
            EXPECT_EQ(r.trace.column(1)[0], -1e-4) << form;
            double impulse = 0;
            for (long n = 0; n < r.trace.rows; ++n) {
                impulse += F[n] / 44100;
                EXPECT_NEAR(3e-3 * (v[0] - v[n]), impulse, 1e-13 * 3e-3 * 3 * 10) << form << n;
            }
            EXPECT_GT(impulse, 3e-3) << form;
            const Ledger l = ledger(r.trace);
            EXPECT_LT(l.row, 1e-13) << form;
            EXPECT_LT(l.sum, 1e-12) << form;
            EXPECT_NEAR(l.lost, 0, 1e-13) << form;
            EXPECT_NEAR(r.trace.energy_column(0)[0], 0.5 * 3e-3 * 9, 1e-15) << form;
        }
}

// with a bridge, a thread, losses and what stands in series
TEST(FreeMass, BalancesBesideAllThatAStringMeets) {
    Scene scene = with_taps(lasting(c3_release(), 10e-3));
    scene.strings[0].masses = {{2e-3, 0.3, 0, 1, 1e-4, 1e5, 1.5},
                               {4e-3, 0.7, 0, -0.1, -2e-3, 1e4, 1}};
    for (const char* form : {"modal_two_point", "modal_three_point", "finite_difference_theta",
                             "modal_two_point compliance=matched", "exact_contact"}) {
        const auto r = play(form, scene, sampled(44100, 60), {.energy = true});
        ASSERT_EQ(r.status.outcome, Outcome::ok) << form;
        const Ledger l = ledger(r.trace);
        const double rounding = form == std::string("exact_contact") ? 1e-9 : 1e-13;
        EXPECT_LT(l.row, rounding) << form;
        EXPECT_GT(l.lost, 1e-3) << form;
    }
    scene.strings[0].masses[0].contact_loss = 0.3;
    for (const char* form : {"modal_two_point", "modal_three_point", "finite_difference_theta"})
        EXPECT_LT(ledger(play(form, scene, sampled(44100, 60), {.energy = true}).trace).row, 1e-13)
            << form;
}

TEST(FreeMass, IsTheSameInBothReferences) {
    struct Case {
        double exponent, stiffness, loss;
        const char* options;
    };
    for (const auto& [exponent, stiffness, loss, options] : {Case{1, 2e4, 0, ""},
                                                             {2.3, 1e9, 0, ""},
                                                             {2.3, 1e9, 0.2, ""},
                                                             {1, 2e4, 0, " compliance=matched"}}) {
        Scene scene = hammered(exponent, stiffness);
        scene.strings[0].masses[0].contact_loss = loss;
        scene.strings[0].barriers = {LumpedBarrier{0.3, 0, -1e-3, {1e5}, 1, 0}};
        scene.taps.push_back({"b", Quantity::bridge_force, 0, 0});
        scene.duration = 12e-3;
        const auto exact = play(std::string("exact_contact") + options, scene, sampled(44100, 60)),
                   other = play(std::string("sundials") + options, scene, sampled(44100, 60));
        ASSERT_GT(largest(exact.trace.column(3)), 1);
        ASSERT_GT(largest(exact.trace.column(4)), 0.1);
        for (int k = 0; k < 5; ++k)
            EXPECT_LT(apart(exact, other, k), k < 3 ? 1e-9 : 2e-8) << k << options << exponent;
        const auto scheme =
            play(std::string("modal_two_point") + options, scene, sampled(16 * 44100, 60));
        for (int k = 0; k < 3; ++k) EXPECT_LT(apart(scheme, exact, k), 2e-3) << k << options;
    }
}

TEST(FreeMass, ThatIsHeavyIsABarrier) {
    Scene pressed = lasting(c3_release(), 10e-3);
    barrier(pressed).height = -1e-5;
    pressed.taps = {{"y", Quantity::displacement, 0, 0.3}, {"F", Quantity::bridge_force, 0, 0}};
    for (const char* form : {"modal_two_point", "modal_three_point", "exact_contact",
                             "modal_two_point compliance=matched", "modal_quadratised"}) {
        const auto truth = play(form, pressed, sampled(44100, 60));
        double before = 1;
        for (const double kg : {1e3, 1e6}) {
            Scene scene = pressed;
            const LumpedBarrier& b = barrier(pressed);
            scene.strings[0].masses = {
                {kg, b.position, b.width, 0, -b.height, b.stiffness.k, b.exponent}};
            scene.strings[0].barriers.clear();
            scene.taps[1].mass = 0;
            const double off = apart(play(form, scene, sampled(44100, 60)), truth, 0);
            EXPECT_LT(off, 1e-3 * before) << form << kg;
            before = 1.5 * off;
        }
        EXPECT_LT(before, 1e-7) << form;
    }
}

// 100 kg at 1 m/s against a string so heavy that it stands still: half a period of 1e6 N/m.
TEST(FreeMass, TellsItsImpacts) {
    Scene scene = one_mode();
    scene.duration = 0.1;
    String& s = scene.strings[0];
    s.linear_density = 2e14;
    s.tension = 1;
    s.masses = {{100, 0.5, 0, 1, 1e-2, 1e6}};
    for (const auto& [form, value] : {std::pair{"exact_contact", 1e-9},
                                      {"modal_two_point", 1e-5},
                                      {"modal_three_point", 1e-5}}) {
        std::vector<Impacts> contacts(scene.strings.begin(), scene.strings.end());
        RunOptions how;
        how.impacts = contacts.data();
        const auto r = play(form, scene, sampled(44100, 1), how);
        ASSERT_EQ(contacts[0].all().size(), 1u) << form;
        const Impact& i = contacts[0].all()[0];
        EXPECT_EQ(i.barrier, 0);
        EXPECT_NEAR(i.largest_force, 1e4, 1e4 * value) << form;
        EXPECT_NEAR(i.impulse, 200, 200 * value) << form;
        EXPECT_NEAR(i.impulse, 100 * (1 - r.trace.column(2).back()), 1e-9) << form;
        EXPECT_NEAR(i.impulse, 100 * (i.speed_in + i.speed_out), 0.2) << form;
        EXPECT_NEAR(i.start, 1e-2, 3e-5) << form;
        EXPECT_NEAR(i.end, 1e-2 + pi / 100, 5e-5) << form;
        EXPECT_NEAR(i.energy_lost, 0, 1e-9) << form;
    }
}

TEST(FreeMass, BelowAStringInEquilibriumLeavesItThere) {
    Scene scene = with_taps(lasting(c3_release(), 2e-3));
    scene.strings[0].start = RestStart{};
    barrier(scene).height = 1e-4;
    scene.strings[0].masses = {{2e-3, 0.4, 0, 0, 0, 1e5}};
    for (const char* form : {"modal_two_point", "modal_two_point compliance=matched",
                             "modal_three_point", "exact_contact"}) {
        const auto r = play(form, scene, sampled(44100, 60));
        EXPECT_LT(largest(r.trace.column(3)), 1e-90) << form;
        EXPECT_GT(r.trace.column(0)[0], 1e-6) << form;
        EXPECT_NEAR(r.trace.column(0).back(), r.trace.column(0)[0], 1e-13) << form;
    }
}

TEST(FreeMass, IsRefusedByWhatHasNone) {
    for (const char* form : {"modal_tension", "modal_generalised_alpha", "modal_explicit_penalty",
                             "modal_moreau_jean", "sitar_fdm", "exact_linear"})
        EXPECT_TRUE(says(refusal(form, one_mode(), sampled(44100, 10)), "free mass")) << form;
}

}  // namespace
}  // namespace jvari
