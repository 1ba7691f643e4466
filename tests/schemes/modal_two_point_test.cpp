// modal_two_point and its trapezoidal control: energy, exact modes, the paper's own figures, and
// what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"
#include "tests/ledger.hpp"
#include "tests/plugin/plain_two_point.hpp"

namespace jvari {
namespace {

const Descriptor& scheme(const std::string& name) {
    return *std::find_if(schemes().begin(), schemes().end(),
                         [&](const Descriptor& d) { return d.name == name; });
}
double fact(const std::vector<Fact>& facts, const std::string& name) {
    return std::find_if(facts.begin(), facts.end(), [&](const Fact& f) { return f.name == name; })
        ->value;
}

TEST(ModalTwoPoint, ConservesEnergyWithoutLossesOverASecond) {
    const auto r = run(scheme("modal_two_point"), lossless(c3_release()), {44100, 44100, 133, {}},
                       {.energy = true});
    const Ledger l = ledger(r.trace);
    EXPECT_LE(l.worst_step, 1e-13);
    EXPECT_LE(l.accumulated, 1e-11);
    for (const double lost : r.trace.energy_column(2)) ASSERT_EQ(lost, 0);
}

TEST(ModalTwoPoint, ClosesItsLedgerWithLossesAndAPluck) {
    for (const Scene& scene : {c3_release(), c3_pluck()}) {
        const auto r =
            run(scheme("modal_two_point"), scene, {44100, 44100, 133, {}}, {.energy = true});
        const Ledger l = ledger(r.trace);
        EXPECT_LE(l.worst_step, 1e-13);
        EXPECT_LE(l.accumulated, 1e-11);
        for (const double lost : r.trace.energy_column(2)) ASSERT_GE(lost, 0);
    }
}

TEST(ModalTwoPoint, ClosesItsLedgerForAPowerLawContact) {
    Scene scene = c3_release();
    auto& barrier = std::get<LumpedBarrier>(scene.strings.front().barriers.front());
    barrier.exponent = 1.5;
    barrier.stiffness.k = 1e12;
    scene.duration = 0.1;
    const auto r = run(scheme("modal_two_point"), scene, {88200, 44100, 133, {}}, {.energy = true});
    EXPECT_EQ(r.status.outcome, Outcome::ok);
    EXPECT_LE(ledger(r.trace).worst_step, 1e-12);
    EXPECT_LE(ledger(r.trace).accumulated, 1e-11);
    EXPECT_GE(fact(r.facts, "smallest_contact_force"), 0);
}

// The paper, section 4.1: compression stays below 3e-8 m; an independent program found 2.03e-8 m at
// 44.1 kHz.
TEST(ModalTwoPoint, ThePluckedC3StringCompressesTheBridgeByLessThan3e8) {
    const auto r = run(scheme("modal_two_point"), c3_pluck(), {44100, 44100, 0, {}});
    EXPECT_EQ(r.dofs, 2 * 133);
    EXPECT_NEAR(fact(r.facts, "deepest_penetration"), 2.03e-8, 0.01e-8);
}

TEST(ModalTwoPoint, MovesEachFreeModeExactlyAtAnyRate) {
    for (const double rate : {44100.0, 64 * 44100.0}) {
        for (const int number : {1, 60, 133}) {
            Scene scene = lossless(c3_free());
            scene.strings.front().initial = ModeInitial{number, 1e-3};
            scene.taps = {{"y", Quantity::displacement, 0, 0.3}, {"v", Quantity::velocity, 0, 0.3}};
            scene.duration = 0.5;
            const auto r = run(scheme("modal_two_point"), scene, {rate, 44100, 133, {}});
            const Modes modes = modes_of(scene.strings.front(), 133);
            const double amplitude = 1e-3 * std::sin(modes.beta[number - 1] * 0.3),
                         omega = modes.omega0[number - 1];
            double worst = 0, worst_velocity = 0;
            for (long n = 0; n < r.trace.rows; ++n) {
                const double t = n / 44100.0;
                worst = std::max(worst,
                                 std::abs(r.trace.column(0)[n] - amplitude * std::cos(omega * t)));
                // q is the momentum by the trapezoidal rule: its amplitude is (2/dt) tan(omega
                // dt/2), not omega
                const double warped = 2 * rate * std::tan(omega / (2 * rate));
                worst_velocity = std::max(
                    worst_velocity,
                    std::abs(r.trace.column(1)[n] + amplitude * warped * std::sin(omega * t)) /
                        warped);
            }
            EXPECT_LT(worst / std::abs(amplitude), 1e-10) << "mode " << number << " at " << rate;
            EXPECT_LT(worst_velocity / std::abs(amplitude), 1e-10)
                << "mode " << number << " at " << rate;
        }
    }
}

TEST(ModalTwoPoint, ReportsThePhaseOffsetOfAStartFromRest) {
    Scene scene = c3_free();
    const auto offset = [&](int modes) {
        return fact(
            make_scheme(scheme("modal_two_point"), scene, {44100, 44100, modes, {}})->facts(),
            "start_phase_offset");
    };
    EXPECT_NEAR(offset(1), 4e-8, 0.5e-8);  // an independent program: 4e-8 rad for mode 1

    // And it is what the trace shows: y(t) = A cos(omega t + phi) exp(-sigma t)/cos(phi), phi from
    // two samples of one mode.
    const int number = 120;
    scene.strings.front().initial = ModeInitial{number, 1e-3};
    scene.duration = 0.001;
    const auto r = run(scheme("modal_two_point"), scene, {44100, 44100, number, {}});
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
    Scene scene = c3_free();
    String& s = scene.strings.front();
    // sigma > omega0 = 822 rad/s for the first two modes
    s.damping = PolynomialDamping{2000, 0, 0};
    for (const int number : {1, 2, 3}) {
        s.initial = ModeInitial{number, 1e-3};
        scene.duration = 0.02;
        const auto r = run(scheme("modal_two_point"), scene, {44100, 44100, 10, {}});
        const Modes m = modes_of(s, 10);
        const double w0 = m.omega0[number - 1], dt = 1 / 44100.0, R2 = std::exp(-2 * 2000 * dt);
        const double root = std::sqrt(std::abs(w0 * w0 - 4e6));
        const double trace =
            2 * std::exp(-2000 * dt) * (w0 < 2000 ? std::cosh(root * dt) : std::cos(root * dt));
        const auto y = r.trace.column(1);
        for (long n = 1; n + 1 < r.trace.rows; ++n)
            // (36)
            ASSERT_NEAR(y[n + 1] - trace * y[n] + R2 * y[n - 1], 0, 1e-12 * std::abs(y[0]))
                << "mode " << number;
    }
}

TEST(ModalTwoPointTrapezoidal, WarpsFrequenciesByTheArctangent) {
    Scene scene = lossless(c3_free());
    scene.strings.front().initial = ModeInitial{50, 1e-3};
    scene.duration = 0.1;
    const auto r = run(scheme("modal_two_point_trapezoidal"), scene, {44100, 44100, 133, {}});
    const double omega0 = modes_of(scene.strings.front(), 50).omega0.back();
    const double warped = 2 * 44100 * std::atan(omega0 / (2 * 44100));
    const auto y = r.trace.column(1);
    for (long n = 0; n < r.trace.rows; ++n)
        ASSERT_NEAR(y[n], y[0] * std::cos(warped * n / 44100), 1e-10 * std::abs(y[0]));
}

TEST(ModalTwoPoint, TheFusedFormIsThePlainForm) {
    for (Scene scene : {c3_release(), c3_pluck()}) {
        for (const int modes : {1, 5, 16, 17, 133}) {  // around the padding
            // with few modes the motion is soon sensitive
            scene.duration = 0.02;
            const Settings settings{44100, 44100, modes, {}};
            PlainTwoPoint<double> plain(scene, settings);
            const auto a = run(scheme("modal_two_point"), scene, settings),
                       b = run(plain, scene, settings);
            for (int k = 0; k < a.trace.taps(); ++k) {
                double largest = 0, difference = 0;
                for (long n = 0; n < a.trace.rows; ++n) {
                    largest = std::max(largest, std::abs(a.trace.column(k)[n]));
                    difference =
                        std::max(difference, std::abs(a.trace.column(k)[n] - b.trace.column(k)[n]));
                }
                EXPECT_LE(difference, 1e-9 * largest)
                    << a.trace.names[k] << ", " << modes << " modes";
            }
        }
    }
}

TEST(ModalTwoPoint, AnExponentJustAbove1IsTheLinearContact) {
    Scene scene = c3_release();
    scene.duration = 0.01;
    const Settings settings{176400, 44100, 133, {}};
    const auto linear = run(scheme("modal_two_point"), scene, settings);
    std::get<LumpedBarrier>(scene.strings.front().barriers.front()).exponent = 1 + 1e-9;
    const auto power = run(scheme("modal_two_point"), scene, settings);
    const auto a = linear.trace.column(2), b = power.trace.column(2);
    const double largest = *std::max_element(a.begin(), a.end());
    for (long n = 0; n < linear.trace.rows; ++n) ASSERT_NEAR(a[n], b[n], 1e-5 * largest) << n;
}

TEST(ModalTwoPoint, RefusesModesThatWouldAlias) {
    try {
        make_scheme(scheme("modal_two_point"), c3_free(), {22050, 22050, 133, {}});
        FAIL();
    } catch (const Refusal& refusal) {
        EXPECT_NE(std::string(refusal.what()).find("not below half the sample rate"),
                  std::string::npos)
            << refusal.what();
    }
    EXPECT_THROW(make_scheme(scheme("modal_two_point"), c3_free(), {44100, 48000, 10, {}}),
                 Refusal);
    EXPECT_THROW(
        make_scheme(scheme("modal_two_point"), c3_free(), {44100, 44100, 10, {{"form", "dense"}}}),
        Refusal);
}

}  // namespace
}  // namespace jvari
