// The integrated reference: its equations against their own derivatives, closed forms of an impact,
// and the exact reference.
#include <Eigen/Dense>
#include <numbers>
#include <random>

#include "bench/check/allocations.hpp"
#include "reference/string_equations.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/claims.hpp"

namespace jvari {
namespace {

using std::numbers::pi;
using Options = OptionValues;

Run integrated(const Scene& scene, int modes, const Options& options = {}, bool energy = false) {
    return run(sundials, scene, {0, 44100, modes, options}, {.energy = energy});
}

// ---- The equations.

struct Equations : testing::Test {
    Equations() {
        Scene scene = c3_pluck();
        String& s = scene.strings.front();
        s.barriers = {LumpedBarrier{10e-3, 2e-3, 0, {4.39e8}, 1, 0},
                      LumpedBarrier{0.3, 0, 1e-5, {1e7}, 1.3, 40},
                      LumpedBarrier{0.7, 0, 0, {1e7}, 2, 0}};
        s.thread->height = 1e-6;
        equations.emplace(modes_of(s, 13), s);
        equations->touched = {1, 1, 0};
        equations->plucked = true;
        equations->pluck_time = 20e-3;
        std::mt19937 random(5);
        std::normal_distribution<double> normal;
        z.resize(equations->size());
        b.resize(equations->size());
        for (int i = 0; i < equations->size(); ++i) {
            z[i] = 1e-3 * normal(random);
            b[i] = normal(random);
        }
        for (int i = 13; i < equations->padded; ++i)
            z[i] = z[equations->padded + i] = b[i] = b[equations->padded + i] = 0;
    }
    std::optional<StringEquations> equations;
    Eigen::VectorXd z, b;
};

TEST_F(Equations, SolveTheNewtonMatrixOfTheirSlopeAsADenseSolverDoes) {
    const int n = equations->size();
    Eigen::MatrixXd jacobian(n, n);
    for (int j = 0; j < n; ++j) {
        Eigen::VectorXd moved = z, up(n), down(n);
        const double step = 1e-8;
        moved[j] += step;
        equations->slope(1e-3, moved.data(), up.data());
        moved[j] -= 2 * step;
        equations->slope(1e-3, moved.data(), down.data());
        jacobian.col(j) = (up - down) / (2 * step);
    }
    for (const double gamma : {1e-9, 1e-7, 1e-5}) {
        Eigen::VectorXd x(n);
        equations->solve(1e-3, gamma, z.data(), b.data(), x.data());
        const Eigen::VectorXd dense =
            (Eigen::MatrixXd::Identity(n, n) - gamma * jacobian).partialPivLu().solve(b);
        EXPECT_LT((x - dense).norm(), 1e-6 * dense.norm()) << "gamma " << gamma;
        EXPECT_LT((x - dense).tail(StringEquations::sums).norm(),
                  1e-5 * dense.tail(StringEquations::sums).norm())
            << "gamma " << gamma;
    }
}

// ---- One mode that falls on a barrier in its middle: a lumped mass on a one-sided spring.

struct Impact {
    double mass = 0.5, omega0 = 100, amplitude = 1e-3;  // [kg], [1/s], [m]
    double speed() const { return omega0 * amplitude; }
    Scene scene(double k, double exponent, double loss) const {
        Scene s;
        s.name = "impact";
        s.duration = 20e-3;
        String string;
        string.length = 1;
        string.linear_density = 2 * mass;
        string.tension = 2 * mass * std::pow(omega0 / pi, 2);
        string.start = ModeShape{1, amplitude};
        string.barriers = {LumpedBarrier{0.5, 0, 0, {k}, exponent, loss}};
        s.strings = {string};
        s.taps = {{"y", Quantity::displacement, 0, 0.5},
                  {"v", Quantity::velocity, 0, 0.5},
                  {"bridge", Quantity::bridge_force, 0, 0}};
        return s;
    }
    struct Outcome {
        double duration, speed;
    };
    // It falls as A cos(omega0 t) and rises as (speed/omega0) sin(omega0 (t - pi/2omega0 -
    // duration)).
    Outcome outcome(const Scene& s, const Options& options) const {
        const auto r = run(sundials, s, {0, 1000, 1, options});
        EXPECT_EQ(r.status.outcome, jvari::Outcome::ok);
        EXPECT_EQ(fact(r, "events"), 2);
        const double y = omega0 * r.trace.column(0)[20], v = r.trace.column(1)[20];
        return {20e-3 - pi / (2 * omega0) - std::atan2(y, v) / omega0, std::hypot(y, v)};
    }
};

TEST(Impact, LastsAsLongAsALinearSpringsHalfPeriod) {
    const Impact impact;
    const double k = 1e9,
                 duration = pi / std::sqrt(k / impact.mass + impact.omega0 * impact.omega0);
    for (const char* method : {"bdf", "adams"}) {
        const auto outcome = impact.outcome(impact.scene(k, 1, 0), {{"method", method}});
        EXPECT_NEAR(outcome.duration, duration, 1e-7 * duration) << method;
        EXPECT_NEAR(outcome.speed, impact.speed(), 1e-7 * impact.speed()) << method;
    }
}

// m v^2/2 = k eta^(a+1)/(a+1): T = 2 eta_max/v int_0^1 du/sqrt(1 - u^(a+1)) = 2 eta_max/v
// B(1/(a+1), 1/2)/(a+1). The string's own stiffness changes it by a part (omega0 T)^2 or so.
TEST(Impact, OfAPowerLawLastsAsTheBetaFunctionSays) {
    const Impact impact;
    for (const double exponent : {1.3, 1.5, 2.0, 2.7}) {
        const double k = 1e7 * std::pow(1e-5, 1 - exponent), n = exponent + 1, v = impact.speed();
        const double deepest = std::pow(n * impact.mass * v * v / (2 * k), 1 / n);
        const double duration = 2 * deepest / v * std::beta(1 / n, 0.5) / n;
        for (const char* method : {"bdf", "adams"}) {
            const auto outcome = impact.outcome(impact.scene(k, exponent, 0), {{"method", method}});
            const double stiffness = std::pow(impact.omega0 * duration, 2);
            ASSERT_LT(stiffness, 0.05);
            EXPECT_NEAR(outcome.duration, duration, stiffness * duration)
                << exponent << " " << method;
            EXPECT_NEAR(outcome.speed, v, 1e-8 * v) << exponent << " " << method;
        }
    }
}

TEST(Impact, IsUnaffectedByTheStringInTheLimitOfAStiffBarrier) {
    const Impact impact;
    double last = 1;
    for (const double k : {1e9, 1e11, 1e13}) {  // exponent 1.3
        const double n = 2.3, v = impact.speed(),
                     deepest = std::pow(n * impact.mass * v * v / (2 * k), 1 / n);
        const double duration = 2 * deepest / v * std::beta(1 / n, 0.5) / n;
        const auto outcome = impact.outcome(impact.scene(k, 1.3, 0), {});
        const double error = std::abs(outcome.duration / duration - 1);
        EXPECT_LT(error, std::pow(impact.omega0 * duration, 2) + 1e-9);
        EXPECT_LT(error, last);
        last = error;
    }
    EXPECT_LT(last, 1e-7);
}

// v dv/(1 + beta v) = -(k/m) eta^a deta, both sides a full differential: v/beta - ln(1 + beta
// v)/beta^2 is the same on the way in and out.
TEST(Impact, LosesToHuntCrossleyWhatTheClosedFormSays) {
    const Impact impact;
    for (const double exponent : {1.0, 1.5}) {
        const double k = 1e9 * std::pow(1e-6, 1 - exponent), beta = 3, v = impact.speed();
        const auto before = v / beta - std::log1p(beta * v) / (beta * beta);
        double low = 0, high = v;
        for (int i = 0; i < 100; ++i) {
            const double out = 0.5 * (low + high);
            (-out / beta - std::log1p(-beta * out) / (beta * beta) < before ? low : high) = out;
        }
        const auto outcome = impact.outcome(impact.scene(k, exponent, beta), {});
        EXPECT_LT(low, 0.9 * v);
        EXPECT_NEAR(outcome.speed, low, 1e-5 * v) << exponent;
    }
}

// The greatest force of a soft point lies within a step: a row around it holds more than the steps'
// ends.
TEST(Impact, TellsItsGreatestForceAndDepthBetweenItsSteps) {
    const Impact impact;
    const double k = 1e5,
                 deepest = impact.speed() / std::hypot(std::sqrt(k / impact.mass), impact.omega0);
    for (const double rate : {1000.0, 8000.0, 44100.0}) {
        const auto r = run(sundials, impact.scene(k, 1, 0), {0, rate, 1, {}});
        EXPECT_NEAR(fact(r, "deepest_penetration"), deepest, 1e-5 * deepest) << rate;
        EXPECT_NEAR(fact(r, "largest_contact_force"), k * deepest, 1e-5 * k * deepest) << rate;
        for (const double force : r.trace.column(2))
            EXPECT_LE(force, (1 + 1e-9) * fact(r, "largest_contact_force")) << rate;
    }
}

// ---- Strings.

Scene two_barriers() {  // of different heights, a thread, a pluck with skew
    Scene scene = c3_pluck();
    scene.duration = 8e-3;
    String& s = scene.strings.front();
    s.barriers = {LumpedBarrier{10e-3, 2e-3, 0, {4.39e8}, 1, 0},
                  LumpedBarrier{0.3, 0, -1e-5, {1e6}, 1, 0}};
    s.pluck->duration = 3e-3;
    s.pluck->start = 0.1e-3;
    s.pluck->skew = 4;
    return scene;
}

TEST(Integrated, AgreesWithTheExactReferenceAndFindsItsEvents) {
    Scene scene = c3_release();
    scene.duration = 8e-3;
    for (const Scene& s : {scene, two_barriers()}) {
        const auto truth = run(exact_contact, s, {0, 44100, 40, {}}), r = integrated(s, 40);
        EXPECT_EQ(fact(r, "events"), fact(truth, "events"));
        EXPECT_GT(fact(r, "events"), 50);
        for (int k = 0; k < 2; ++k) EXPECT_LT(apart(r, truth, k), 1e-9) << r.trace.names[k];
        for (int k = 2; k < 4; ++k) EXPECT_LT(apart(r, truth, k), 1e-6) << r.trace.names[k];
    }
}

TEST(Integrated, ByAnyMethodIsTheSame) {
    Scene scene = c3_release();
    scene.duration = 4e-3;
    const auto truth = run(exact_contact, scene, {0, 44100, 20, {}});
    for (const Options& o : {Options{{"method", "bdf"}}, Options{{"method", "adams"}},
                             Options{{"method", "bdf"}, {"flight", "integrate"}},
                             Options{{"method", "adams"}, {"flight", "integrate"}}}) {
        const auto r = integrated(scene, 20, o);
        ASSERT_EQ(r.status.outcome, Outcome::ok) << o[0].second;
        EXPECT_LT(apart(r, truth, 0), 3e-8) << o[0].second << " " << o.back().second;
        EXPECT_EQ(fact(r, "events"), fact(truth, "events"))
            << o[0].second << " " << o.back().second;
    }
}

Scene power_law(double loss) {
    Scene scene = c3_release();
    scene.duration = 5e-3;
    scene.strings.front().barriers = {LumpedBarrier{10e-3, 2e-3, 0, {1e10}, 1.3, loss}};
    return scene;
}

TEST(Integrated, PowerLawsAgreeBetweenIntegratorsAndTolerances) {
    const Scene scene = power_law(0);
    const auto best = integrated(scene, 20);
    for (const Options& o : {Options{{"rtol", "1e-12"}}, Options{{"method", "bdf"}}}) {
        const auto r = integrated(scene, 20, o);
        EXPECT_LT(apart(r, best, 0), 1e-7);
        EXPECT_EQ(fact(r, "events"), fact(best, "events"));
    }
}

TEST(Integrated, AgreesWithItselfOverTwentyMillisecondsOfTheTwoPointBridge) {
    Scene scene = read_scene("two_point_bridge");
    scene.duration = 20e-3;
    const auto best = integrated(scene, 16);
    EXPECT_GT(fact(best, "events"), 20);
    for (const Options& o : {Options{{"rtol", "1e-12"}}, Options{{"method", "bdf"}}}) {
        const auto r = integrated(scene, 16, o);
        EXPECT_EQ(fact(r, "events"), fact(best, "events"));
        for (int k = 0; k < 3; ++k) EXPECT_LT(apart(r, best, k), 1e-7) << r.trace.names[k];
    }
}

TEST(Integrated, BalancesTheEnergyOfContactLoss) {
    const auto balances = [](double loss, const LedgerClaim::Lost& lost) {
        holds(LedgerClaim("", {"sundials"}, {lossless(power_law(loss))}, {{0}, 44100, 20}, {1e-10},
                          lost));
    };
    balances(0, {.at_most = 0});
    balances(0.5, {.more_than = 1e-3});
}

TEST(Integrated, StartsInContactWhereTheSceneDoes) {
    Scene scene = c3_release();
    scene.duration = 2e-3;
    scene.strings.front().start = ModeShape{1, -1e-6};
    const auto truth = run(exact_contact, scene, {0, 44100, 20, {}});
    for (const char* flight : {"exact", "integrate"}) {
        const auto r = integrated(scene, 20, {{"flight", flight}});
        EXPECT_LT(apart(r, truth, 0), 1e-8) << flight;
    }
}

Scene pressed(double exponent) {  // at rest, 3 um into a stiff point
    Scene scene;
    scene.name = "pressed";
    scene.duration = 1e-3;
    String s;
    s.length = 0.76;
    s.linear_density = 0.0045;
    s.tension = 8.6;
    s.bending_stiffness = 9.8e-5;
    s.barriers = {LumpedBarrier{0.32, 0.1, 2.8e-6, {5.9e8}, exponent, 0}};
    scene.strings = {s};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}, {"y", Quantity::displacement, 0, 0.32}};
    return scene;
}

TEST(Integrated, StartsFromRestWhereABarrierPresses) {
    const auto truth = run(exact_contact, pressed(1), {0, 44100, 20, {}});
    for (const char* flight : {"exact", "integrate"}) {
        const auto r = integrated(pressed(1), 20, {{"flight", flight}}, true);
        ASSERT_EQ(r.status.outcome, Outcome::ok) << flight;
        EXPECT_LT(apart(r, truth, 1), 1e-7) << flight;
    }
    const auto r = integrated(pressed(1.15), 20, {}, true),
               coarser = integrated(pressed(1.15), 20, {{"rtol", "1e-12"}});
    ASSERT_EQ(r.status.outcome, Outcome::ok);
    EXPECT_LT(apart(r, coarser, 1), 1e-7);
    EXPECT_GT(r.trace.energy_column(0)[0], 0);
    EXPECT_LE(ledger(r.trace).row, 1e-9);
}

// Its force is known to the rounding of the barrier's height. A tolerance below that makes steps of
// 1e-12 s.
TEST(Integrated, RestsOnAStiffBridgeInNoMoreStepsThanItsContactIsFast) {
    Scene scene = read_scene("tanpura_c3", {"string.0.barrier.0.height=1e-3",
                                            "string.0.thread.height=5e-4", "string.0.start=rest"});
    scene.duration = 0.2e-3;
    scene.strings.front().pluck.reset();
    const auto r = integrated(scene, 40);
    ASSERT_EQ(r.status.outcome, Outcome::ok);
    EXPECT_LT(fact_of(r.facts, facts::integrator_steps), 1e4);  // 1e7 rad/s
    EXPECT_EQ(fact_of(r.facts, facts::events), 1);              // it touches
    for (int k = 0; k < 2; ++k)
        for (const double y : r.trace.column(k))
            EXPECT_NEAR(y, r.trace.column(k)[0], 1e-12 * std::abs(r.trace.column(k)[0]));
}

TEST(Integrated, OfAStringAtRestUnderAThreadOrAPluckRunsToo) {
    Scene raised = c3_pluck();
    raised.duration = 2e-3;
    raised.strings.front().pluck.reset();
    raised.strings.front().thread->height = 1e-5;
    Scene plucked = c3_pluck();
    plucked.duration = 2e-3;
    for (const Scene& scene : {raised, plucked}) {
        const auto truth = run(exact_contact, scene, {0, 44100, 20, {}});
        const auto r = integrated(scene, 20, {{"flight", "integrate"}});
        ASSERT_EQ(r.status.outcome, Outcome::ok);
        EXPECT_LT(apart(r, truth, 0), 1e-6);
    }
}

TEST(Integrated, ThatFailsOnItsWayKeepsTheRowsBefore) {
    Scene scene = c3_release();
    scene.duration = 2e-3;
    std::get<LumpedBarrier>(scene.strings.front().barriers.front()).stiffness.k = 1e300;
    for (const bool energy : {false, true}) {
        const auto r = integrated(scene, 133, {}, energy);
        ASSERT_EQ(r.status.outcome, Outcome::not_converged);
        EXPECT_EQ(r.trace.rows, r.status.step + 1);
        EXPECT_LE(r.trace.rows, r.trace.stride);
    }
}

TEST(References, OfAStringWithoutAModeBelow20kHzRefuse) {
    Scene scene = c3_release();
    scene.strings.front().length = 4e-3;
    scene.strings.front().barriers = {LumpedBarrier{2e-3, 0, 0, {1e5}, 1, 0}};
    scene.strings.front().thread.reset();
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}};
    ASSERT_EQ(modes_below(scene.strings.front(), 20e3), 0);
    EXPECT_THROW(run(sundials, scene, {0, 44100, 0, {}}), Refusal);
    EXPECT_THROW(run(exact_contact, scene, {0, 44100, 0, {}}), Refusal);
    scene.strings.front().barriers.clear();
    EXPECT_THROW(run(exact_linear, scene, {0, 44100, 0, {}}), Refusal);
}

struct Enough {};

TEST(References, CanBeEndedWithinARow) {  // of 2^20 s
    for (const Descriptor& d : references()) {
        Scene scene = c3_pluck();
        scene.strings.front().pluck->duration = 1e9;
        if (d.name == std::string("exact_linear")) {
            scene = c3_free();
            scene.strings.front().pluck = Pluck{-0.4, 1e9, 0, 0, 0.5, 0};
        }
        const bool integrated = d.name == std::string("sundials");
        if (integrated) scene = c3_release();
        // of 2^31 steps a row at most
        const bool lattice = d.name == std::string("characteristic_lattice");
        if (lattice)
            scene = read_scene("flat_bridge_ideal", {"string.0.barrier.0.stiffness_density=rigid"});
        scene.duration = 1e7;
        int words = 0;
        const RunOptions until_enough{.progress = [&](long, long) {
            if (++words == 2) throw Enough{};
        }};
        const Options all_of_it = integrated ? Options{{"flight", "integrate"}} : Options{};
        EXPECT_THROW(
            run(d, scene, {0, 1.0 / (lattice ? 1 << 7 : 1 << 20), 20, all_of_it}, until_enough),
            Enough)
            << d.name;
    }
}

TEST(Integrated, AllocatesNothingAndRepeatsItselfByAnyMethod) {
    Scene scene = c3_release();
    const int taps = static_cast<int>(scene.taps.size());
    for (const Options& o : {Options{{"method", "bdf"}}, Options{{"method", "adams"}},
                             Options{{"flight", "integrate"}}}) {
        const auto scheme = make_scheme(sundials, scene, {0, 44100, 10, o});
        std::vector<double> first(128 * taps), again(first), energy(3 * 128);
        const bench::check::Allocations allocations;
        EXPECT_EQ(scheme->advance({128, taps, 128, first.data(), nullptr}).outcome, Outcome::ok);
        scheme->reset();
        scheme->advance({64, taps, 128, again.data(), energy.data()});
        scheme->advance({64, taps, 128, again.data() + 64, nullptr});
        EXPECT_EQ(allocations.count(), 0) << o[0].second;
        EXPECT_TRUE(first == again) << o[0].second;
    }
}

}  // namespace
}  // namespace jvari
