// Rules of impact and of mean forces against closed forms: a free mass that strikes a barrier, one
// mode of generalised-alpha, one equation.
#include <numbers>

#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/contact/end_forces_rule.hpp"
#include "schemes/contact/moreau_jean_rule.hpp"
#include "tests/runs.hpp"
#include "tests/schemes/contact_points.hpp"

namespace jvari {
namespace {

// A mass m that flies at v [m/s] and strikes: its speed after is -e v, and m v^2 (1 - e^2)/2 is
// lost.
TEST(MoreauJean, AMassLeavesWithItsSpeedTimesTheCoefficientAndLosesTheRest) {
    constexpr double m = 0.2, dt = 1e-3, v = -1.5;
    for (const int levels : {1, 2})
        for (const double e : {0.0, 0.3, 1.0}) {
            const ContactLaw law{1e8, 1};
            const double theta = levels == 1 ? dt * dt / (2 * m) : dt * dt / m;
            MoreauJeanRule rule(std::span(&law, 1), std::span(&theta, 1), levels);
            rule.choose({1 / dt, 1 / dt, 1, {{"restitution", std::to_string(e)}}});
            // it strikes in the third step
            double eta = -2.2 * -v * dt, older = eta + v * dt, now_speed = v, lost = 0;
            const double moving = v * dt;
            rule.begin(&eta, &moving);
            for (int step = 0; step < 6; ++step) {
                // minus the free increment
                const double b = -(levels == 1 ? now_speed * dt : 2 * now_speed * dt);
                double r = 0, F = 0;
                rule.solve({levels == 1 ? &eta : &older, &eta, &b}, &r, &F);
                lost += rule.lost();
                EXPECT_GE(F, 0);
                now_speed = levels == 1 ? 2 * r / dt - now_speed : r / dt - now_speed;
                older = eta;
                eta = levels == 1 ? eta - r : eta - now_speed * dt;
            }
            EXPECT_NEAR(now_speed, -e * v, 1e-12) << "levels " << levels << ", e " << e;
            EXPECT_NEAR(lost, 0.5 * m * v * v * (1 - e * e), 1e-12)
                << "levels " << levels << ", e " << e;
        }
}

TEST(EndForces, AreTheMeanOfThoseAtBothEndsForOnePointAndForSeveral) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const double alpha : {1.0, 1.5})
        for (const int n : {1, 3})
            for (int draw = 0; draw < 200; ++draw) {
                Points p;
                for (int a = 0; a < n; ++a) p.contacts.add({alpha == 1 ? 1e7 : 1e9, alpha}, 0, 0);
                couple(p, random, 1e-3);
                const double share = 0.5 + 0.4 * unit(random);
                EndForcesRule rule(p.contacts.laws, p.theta, share);
                double eta[3], b[3], r[3], F[3];
                for (int a = 0; a < n; ++a)
                    eta[a] = 1e-6 * unit(random), b[a] = 3e-6 * unit(random);
                const BeforeStep at{eta, eta, b};
                if (!rule.acts(at)) continue;
                ASSERT_TRUE(rule.solve(at, r, F).converged);
                for (int a = 0; a < n; ++a) {
                    const ContactLaw& law = p.contacts.laws[a];
                    const double mean =
                        (1 - share) * law.force(eta[a] - r[a]) + share * law.force(eta[a]);
                    double moved = -b[a];
                    for (int c = 0; c < n; ++c) moved += p.theta[a * n + c] * F[c];
                    EXPECT_NEAR(F[a], mean, 1e-7 * (std::abs(mean) + law.force(3e-6)));
                    EXPECT_NEAR(r[a], moved, 1e-12 * 1e-5);
                }
            }
}

Trace free_mode(const char* method, const char* rho, int number, double rate) {
    const Scene scene = read_scene(
        "free_string",
        {"string.0.damping.law=none", "duration=0.06", "string.0.start.shape=mode",
         "string.0.start.number=" + std::to_string(number), "string.0.start.amplitude=1e-3"});
    const Settings s{rate, rate, number, {{"method", method}, {"rho", rho}}};
    return run(named("modal_generalised_alpha"), scene, s, {.energy = true}).trace;
}

// rho = 1 is the trapezoidal rule: a mode turns by 2 atan(omega dt/2) in a step, and keeps its
// energy.
TEST(GeneralisedAlpha, WithoutDampingIsTheTrapezoidalRule) {
    const Scene scene = read_scene("free_string");
    const double rate = 4000, omega = modes_of(scene.strings[0], 3).omega0[2];
    for (const char* method : {"generalised_alpha", "hht"}) {
        const Trace t = free_mode(method, "1", 3, rate);
        for (long n = 0; n < t.rows; ++n) {
            EXPECT_NEAR(t.column(0)[n] / t.column(0)[0],
                        std::cos(2 * n * std::atan(0.5 * omega / rate)), 1e-10)
                << method << n;
            EXPECT_NEAR(t.energy_column(0)[n] / t.energy_column(0)[0], 1, 1e-10) << method << n;
        }
    }
}

// rho = 0 annihilates what the rate cannot resolve; rho = 1/2 of HHT keeps less than half of it per
// step, and both leave low modes alone.
TEST(GeneralisedAlpha, DampsModesFarAboveTheRateAsItsOptionSays) {
    const auto left = [](const char* method, const char* rho, int number, double rate) {
        const Trace t = free_mode(method, rho, number, rate);
        return std::sqrt(t.energy_column(0)[12] / t.energy_column(0)[0]);
    };
    EXPECT_LT(left("generalised_alpha", "0", 100, 200), 1e-2);  // after 12 steps
    EXPECT_NEAR(left("generalised_alpha", "1", 100, 200), 1, 1e-9);
    EXPECT_LT(left("generalised_alpha", "0.5", 100, 200), 0.5);
    EXPECT_GT(left("generalised_alpha", "0", 1, 88200), 0.999999);
    EXPECT_GT(left("hht", "0.5", 1, 88200), 0.999999);
}

}  // namespace
}  // namespace jvari
