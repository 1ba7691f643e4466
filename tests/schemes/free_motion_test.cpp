// Strings that touch nothing: those that are exact in time against the closed form, all others
// against their own relation, and these relations against what theory says of them.
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

using std::numbers::pi;

Scene heard(Scene scene, const Start& start, double seconds) {
    scene.strings.front().start = start;
    scene.taps = {{"y", Quantity::displacement, 0, 0.3},
                  {"v", Quantity::velocity, 0, 0.3},
                  {"nut", Quantity::nut_force, 0, 0}};
    return lasting(scene, seconds);
}

struct ExactClaim {
    std::string name, form;
    Scene scene;
    double rate;
    int modes;
    std::vector<int> taps = {0};
    double error = 1e-10, tap_rate = 44100;
};

std::vector<ExactClaim> exact_claims() {
    const Scene lossy = c3_free(), quiet = lossless(c3_free());
    const Start wide = TriangleShape{0.2, 2e-3, 0.02};
    const std::string two = "modal_two_point", three = "modal_quadratised levels=3",
                      newton = "modal_spatial_newton", moments = "modal_two_moment";
    std::vector<ExactClaim> all{
        {"QuadratisedInTwoLevels", "modal_quadratised", heard(quiet, wide, 0.5), 44100, 100},
        {"QuadratisedInThreeLevels", three, heard(quiet, wide, 0.5), 44100, 100},
        {"QuadratisedInThreeLevelsWithLosses", three, heard(lossy, wide, 0.5), 44100, 100},
        // omega0 of mode 1 is 822/s
        {"QuadratisedInThreeLevelsOverdamped",
         three,
         heard(with_damping(lossy, PolynomialDamping{1500, 0, 0}), ModeShape{1, 1e-3}, 0.01),
         44100,
         1,
         {0},
         1e-12},
        {"TwoMoments", moments, heard(quiet, wide, 1), 44100, 133, {0, 1, 2}, 1e-10, 88.2},
        {"Newton", newton, heard(quiet, wide, 1), 44100, 133, {0, 1, 2}, 1e-10, 88.2},
        {"NewtonWithLosses", newton, heard(lossy, wide, 1), 44100, 133, {0, 1, 2}, 1e-10, 88.2},
        // 2 - C loses omega dt^2: the plain recursion is detuned by 1e-7 here
        {"NewtonAfterAMillionSteps",
         newton,
         heard(quiet, wide, 1),
         1e6,
         12,
         {0, 1, 2},
         1e-10,
         2000},
        // mode 1 is overdamped, the others not
        {"NewtonOverdamped",
         newton,
         heard(with_damping(lossy, PolynomialDamping{3 * pi * 131, 0, 0}), wide, 0.2),
         44100,
         20,
         {0, 1, 2},
         1e-10,
         88.2}};
    for (const int times : {1, 64})
        for (const int mode : {1, 61, 133})
            all.push_back({"TwoPointInMode" + std::to_string(mode) + "At" + std::to_string(times),
                           two, heard(quiet, ModeShape{mode, 1e-3}, 0.5), times * 44100.0, 133});
    return all;
}
void PrintTo(const ExactClaim& c, std::ostream* out) { *out << c.name; }

class FreeMotion : public testing::TestWithParam<ExactClaim> {};
TEST_P(FreeMotion, IsTheClosedForm) {
    const ExactClaim& c = GetParam();
    const auto r = play(c.form, c.scene, {c.rate, c.tap_rate, c.modes, {}}),
               truth = play("exact_linear", c.scene, {0, c.tap_rate, c.modes, {}});
    ASSERT_EQ(r.trace.rows, truth.trace.rows);
    for (const int tap : c.taps)
        EXPECT_LT(largest_difference(r.trace.column(tap), truth.trace.column(tap)),
                  c.error * largest(truth.trace.column(tap)))
            << tap;
}
INSTANTIATE_TEST_SUITE_P(, FreeMotion, testing::ValuesIn(exact_claims()),
                         [](const auto& one) { return one.param.name; });

FreeMode own_mode(const std::string& form, const Scene& scene, int mode) {
    Settings s{44100, 44100, 133, {}};
    const Descriptor& d = with_options(form, s);
    return make_scheme(d, scene, s)->free_modes().at(mode - 1);
}

// y[n+1] = 2 R cos(omega dt) y[n] - R^2 y[n-1], R = exp(-sigma dt), of what the scheme itself says:
// 1e-3 cents or 1e-4/s amiss would show in the last digit that is asked for here.
TEST(OwnRelation, IsWhatTheTraceOfAModeFollowsFromRowToRow) {
    const double dt = 1 / 44100.0;
    int count = 0;
    for (const auto& table : {schemes(), std::span(schemes_of_pairings())})
        for (const Descriptor& d : table)
            for (const Scene& base : {lossless(c3_free()), c3_free()})
                for (int mode = 1; mode <= 30; ++mode) {
                    const Scene scene = heard(base, ModeShape{mode, 1e-3}, 0.02);
                    const Settings s{44100, 44100, 133, {}};
                    if (!represents(d, scene) || !refusal(d.name, scene, s).empty()) break;
                    if (make_scheme(d, scene, s)->free_modes().empty()) break;
                    if (mode % 10 == 0) continue;  // 0.3 m is a node
                    const FreeMode own = own_mode(d.name, scene, mode);
                    const double R = std::exp(-own.sigma * dt),
                                 p = 2 * R * std::cos(own.omega * dt);
                    const auto r = run(d, scene, s);
                    const auto y = r.trace.column(0);
                    double worst = 0;
                    for (std::size_t n = 1; n + 1 < y.size(); ++n)
                        worst = std::max(worst, std::abs(y[n + 1] - p * y[n] + R * R * y[n - 1]));
                    EXPECT_LT(worst, 1e-11 * largest(y)) << d.name << " mode " << mode;
                    ++count;
                }
    EXPECT_GT(count, 7 * 2 * 27);
}

TEST(OwnRelation, OfALosslessModeIsACosineFromTheFirstSample) {
    for (const char* form : {"modal_two_point_trapezoidal", "finite_difference_explicit",
                             "finite_difference_theta", "finite_difference_hamiltonian"})
        for (const int mode : {1, 7, 23, 51}) {
            const Scene scene = heard(lossless(c3_free()), ModeShape{mode, 1e-3}, 0.1);
            const double omega = own_mode(form, scene, mode).omega;
            const auto r = play(form, scene, {44100, 44100, 133, {}});
            const auto y = r.trace.column(0);
            for (std::size_t n = 0; n < y.size(); ++n)
                ASSERT_NEAR(y[n], y[0] * std::cos(omega * n / 44100), 1e-10 * std::abs(y[0]))
                    << form << " " << n;
        }
}

TEST(OwnRelation, OfTrapezoidalRulesWarpsByTheArctangent) {
    const Scene scene = lossless(c3_free());
    const String& s = scene.strings.front();
    const auto warped = [](double omega) { return 2 * 44100 * std::atan(omega / (2 * 44100)); };
    for (const int i : {1, 50, 133}) {
        const double omega0 = modes_of(s, i).omega0.back();
        EXPECT_NEAR(own_mode("modal_two_point_trapezoidal", scene, i).omega, warped(omega0),
                    1e-9 * omega0);
    }
    for (const int i : {1, 50, 154}) {
        const double lambda = std::pow(2 * 155 / s.length * std::sin(0.5 * pi * i / 155), 2);
        const double omega = std::sqrt(
            (s.tension * lambda + s.bending_stiffness * lambda * lambda) / s.linear_density);
        EXPECT_NEAR(own_mode("finite_difference_hamiltonian grid=155", scene, i).omega,
                    warped(omega), 1e-9 * omega);
    }
}

TEST(OwnRelation, OfTheTunedThetaIsFarNearerToTheStringThanThatOfTheExplicitGrid) {
    const Scene scene = lossless(c3_free());
    const Modes exact = modes_of(scene.strings.front(), 60);
    for (const int i : {20, 60}) {
        const auto cents = [&](const char* form) {
            return std::abs(1200 * std::log2(own_mode(form, scene, i).omega / exact.omega0[i - 1]));
        };
        EXPECT_LT(cents("finite_difference_theta"),
                  cents("finite_difference_explicit") / (i < 50 ? 20 : 4));
    }
}

// q is the momentum by the trapezoidal rule: its amplitude is (2/dt) tan(omega dt/2), not omega.
TEST(Velocities, OfTwoPointAreWarpedByTheTangent) {
    for (const double rate : {44100.0, 64 * 44100.0})
        for (const int mode : {1, 61, 133}) {
            const Scene scene = heard(lossless(c3_free()), ModeShape{mode, 1e-3}, 0.5);
            const double omega = modes_of(scene.strings.front(), mode).omega0.back(),
                         amplitude = 1e-3 * std::sin(mode * pi * 0.3) * 2 * rate *
                                     std::tan(omega / (2 * rate));
            const auto r = play("modal_two_point", scene, {rate, 44100, 133, {}});
            for (long n = 0; n < r.trace.rows; ++n)
                ASSERT_NEAR(r.trace.column(1)[n], -amplitude * std::sin(omega * n / 44100.0),
                            1e-10 * std::abs(amplitude))
                    << mode << " at " << rate;
        }
}

TEST(Velocities, OfQuadratisedFormsInThreeLevelsAreSecondOrderDifferences) {  // low modes
    const Scene scene = heard(c3_free(), TriangleShape{0.2, 2e-3, 0.02}, 0.01);
    const auto r = play("modal_quadratised levels=3", scene, {16 * 44100, 44100, 5, {}});
    const auto y = r.trace.column(0), v = r.trace.column(1);
    EXPECT_EQ(v[0], 0);
    for (long n = 1; n + 1 < r.trace.rows; ++n)
        EXPECT_NEAR(v[n], (y[n + 1] - y[n - 1]) * 22050, 0.02 * 2);
}

}  // namespace
}  // namespace jvari
