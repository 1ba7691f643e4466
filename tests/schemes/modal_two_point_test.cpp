// modal_two_point: the paper's own figures, its start, and that forms of it agree.
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/plugin/plain_two_point.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

// The paper, section 4.1: compression stays below 3e-8 m; an independent program found 2.03e-8 m at
// 44.1 kHz.
TEST(ModalTwoPoint, ThePluckedC3StringCompressesTheBridgeByLessThan3e8) {
    const auto r = play("modal_two_point", c3_pluck(), {44100, 44100, 0, {}});
    EXPECT_EQ(r.dofs, 2 * 133);
    EXPECT_NEAR(fact(r, "deepest_penetration"), 2.03e-8, 0.01e-8);
}

TEST(ModalTwoPoint, ReportsThePhaseOffsetOfAStartFromRest) {
    Scene scene = lasting(c3_free(), 0.001);
    const auto offset = [&](int modes) {
        return fact(
            make_scheme(named("modal_two_point"), scene, {44100, 44100, modes, {}})->facts(),
            "start_phase_offset");
    };
    EXPECT_NEAR(offset(1), 4e-8, 0.5e-8);  // an independent program: 4e-8 rad for mode 1

    // And it is what the trace shows: y(t) = A cos(omega t + phi) exp(-sigma t)/cos(phi), phi from
    // two samples of one mode.
    const int number = 120;
    scene.strings.front().start = ModeShape{number, 1e-3};
    const auto r = play("modal_two_point", scene, {44100, 44100, number, {}});
    const Modes modes = modes_of(scene.strings.front(), number);
    const double sigma = modes.sigma.back(),
                 omega = std::sqrt(omega_squared_damped(modes.omega0.back(), sigma)),
                 dt = 1 / 44100.0;
    const auto y = r.trace.column(1);
    const auto phase = [&](double y1) {
        return std::atan((std::cos(omega * dt) - y1 * std::exp(sigma * dt)) / std::sin(omega * dt));
    };
    const double rest = std::atan2(-sigma, omega);  // of a motion that starts at rest
    EXPECT_NEAR(std::abs(phase(y[1] / y[0]) - rest), offset(number), 1e-9);
}

TEST(ModalTwoPoint, OverdampedModesDecayAlongTheirTwoRealRoots) {
    Scene scene = lasting(c3_free(), 0.02);
    String& s = scene.strings.front();
    // sigma > omega0 = 822 rad/s for the first two modes
    s.damping = PolynomialDamping{2000, 0, 0};
    for (const int number : {1, 2, 3}) {
        s.start = ModeShape{number, 1e-3};
        const auto r = play("modal_two_point", scene, {44100, 44100, 10, {}});
        const double w0 = modes_of(s, 10).omega0[number - 1], dt = 1 / 44100.0,
                     R2 = std::exp(-2 * 2000 * dt), root = std::sqrt(std::abs(w0 * w0 - 4e6));
        const double trace =
            2 * std::exp(-2000 * dt) * (w0 < 2000 ? std::cosh(root * dt) : std::cos(root * dt));
        const auto y = r.trace.column(1);
        for (long n = 1; n + 1 < r.trace.rows; ++n)  // (36)
            ASSERT_NEAR(y[n + 1] - trace * y[n] + R2 * y[n - 1], 0, 1e-12 * std::abs(y[0]))
                << "mode " << number;
    }
}

TEST(ModalTwoPoint, TheFusedFormIsThePlainForm) {
    for (const Scene& whole : {c3_release(), c3_pluck()})
        for (const int modes : {1, 5, 16, 17, 133}) {  // around the padding
            // with few modes the motion is soon sensitive
            const Scene scene = lasting(whole, 0.02);
            const Settings settings{44100, 44100, modes, {}};
            PlainTwoPoint<double> plain(scene, settings);
            const auto a = play("modal_two_point", scene, settings),
                       b = run(plain, scene, settings);
            for (int k = 0; k < a.trace.taps(); ++k)
                EXPECT_LE(largest_difference(a.trace.column(k), b.trace.column(k)),
                          1e-9 * largest(a.trace.column(k)))
                    << a.trace.names[k] << ", " << modes << " modes";
        }
}

TEST(ModalTwoPoint, AnExponentJustAbove1IsTheLinearContact) {
    const Scene scene = lasting(c3_release(), 0.01);
    const Settings settings{176400, 44100, 133, {}};
    const auto a = play("modal_two_point", scene, settings),
               b = play("modal_two_point", with_exponent(scene, 1 + 1e-9), settings);
    EXPECT_LE(largest_difference(a.trace.column(2), b.trace.column(2)),
              1e-5 * largest(a.trace.column(2)));
}

// One contact goes through other code than one of several.
TEST(SeveralPoints, OneThatIsInReachIsTheOneOfOnePoint) {
    for (Scene one : {lasting(c3_release(), 0.01), lasting(c3_pluck(), 0.01)})
        for (const double exponent : {1.0, 1.5})
            for (const std::string form :
                 {"modal_two_point", "modal_two_point_trapezoidal", "modal_quadratised",
                  "modal_quadratised variant=raw", "modal_explicit_penalty"}) {
                const bool is_explicit = form == "modal_explicit_penalty";
                if (is_explicit) barrier(one).stiffness.k = 1e6, one.duration = 3e-3;
                one = with_exponent(one, exponent);
                Scene two = one;
                two.strings[0].barriers.push_back(LumpedBarrier{0.6, 0, -1, {1e8}, 1, 0.5});
                const Settings settings{is_explicit ? 8 * 44100.0 : 88200.0, 44100, 60, {}};
                const auto a = play(form, one, settings, {.energy = true}),
                           b = play(form, two, settings, {.energy = true});
                EXPECT_EQ(fact(b, "contact_points"), 2);
                EXPECT_EQ(b.dofs, a.dofs + form.starts_with("modal_quadratised"));
                for (int k = 0; k < a.trace.taps(); ++k)
                    EXPECT_LT(apart(b, a, k), is_explicit ? 1e-9 : 1e-7) << form << " " << k;
                EXPECT_LT(relative_difference(b.trace.energy_column(0), a.trace.energy_column(0)),
                          is_explicit ? 1e-9 : 1e-12)
                    << form;
                EXPECT_NEAR(fact(b, "smallest_contact_force"), fact(a, "smallest_contact_force"),
                            1e-6)
                    << form;
            }
}

}  // namespace
}  // namespace jvari
