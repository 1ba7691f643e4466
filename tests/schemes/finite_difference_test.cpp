// Finite differences: weights on nodes, the fit of losses, stability limits, contact on nodes.
#include <numbers>

#include "scenes/barrier.hpp"
#include "scenes/modes.hpp"
#include "schemes/grid/grid_solve.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

using std::numbers::pi;

const std::string all[] = {"finite_difference_explicit", "finite_difference_theta",
                           "finite_difference_hamiltonian"};
const std::string &explicit_ = all[0], &theta_ = all[1], &hamiltonian_ = all[2];

Run at(double rate, const std::string& form, const Scene& scene, double tap_rate = 0) {
    return play(form, scene, {rate, tap_rate > 0 ? tap_rate : rate, 0, {}}, {.energy = true});
}

// ---- Weights on nodes.

TEST(GridWeights, FootprintIsItsIntegralAgainstTheHatFunctionsAndReadsALineExactly) {
    const Grid g{50, 0.02};
    for (double width : {0.0, 0.002, 0.02, 0.13}) {
        const double x0 = 0.3071;
        const Stencil s = footprint_stencil(g, x0, width);
        std::vector<double> line(51), one(51, 1.0);
        for (int l = 0; l <= 50; ++l) line[l] = l * g.dx;
        EXPECT_NEAR(s.read(one.data()), 1, 1e-13);
        EXPECT_NEAR(s.read(line.data()), x0, 1e-13);
        if (width == 0) continue;
        for (std::size_t j = 0; j < s.weight.size(); ++j) {
            double sum = 0;
            const int n = 20000;
            for (int k = 0; k < n; ++k) {  // midpoint rule
                const double u = -width / 2 + (k + 0.5) * width / n;
                const double hat =
                    std::max(0.0, 1 - std::abs((x0 + u) / g.dx - (s.first + static_cast<int>(j))));
                sum += pi / (2 * width) * std::cos(pi * u / width) * hat * width / n;
            }
            EXPECT_NEAR(s.weight[j], sum, 1e-7) << width;
        }
    }
    const Stencil edge = footprint_stencil(g, 0.5, 1.0);  // the whole string
    EXPECT_EQ(edge.first, 1);
    EXPECT_EQ(edge.weight.size(), 49u);
}

TEST(GridWeights, DisplacementAndNutForceAreReadToFourthOrderUpToTheEnds) {
    const String s = c3_free().strings.front();
    double last_y = 0, last_nut = 0;
    for (int N : {40, 80, 160}) {
        const Grid g{N, s.length / N};
        std::vector<double> u(N + 1);
        const double beta = 7 * pi / s.length;
        for (int l = 0; l <= N; ++l) u[l] = std::sin(beta * l * g.dx);
        double y = 0;
        for (double x : {0.003, 0.41, 0.997, 1.0})
            y = std::max(y,
                         std::abs(displacement_stencil(g, x).read(u.data()) - std::sin(beta * x)));
        const double exact =
            -std::cos(beta) * beta * (s.tension + s.bending_stiffness * beta * beta);
        const double nut = std::abs(nut_force_stencil(g, s).read(u.data()) / exact - 1);
        if (N > 40) {
            EXPECT_GT(last_y / y, 10);
            EXPECT_NEAR(last_nut / nut, 16, 1);
        }
        last_y = y;
        last_nut = nut;
    }
}

// Sums over neighbours where what is off the diagonal falls fast, factors elsewhere: both to
// rounding, whatever the ends.
TEST(GridWeights, GridSolveIsTheFactorsToRounding) {
    int summed = 0, factored = 0;
    for (const int N : {6, 40, 41, 47, 64, 155, 436, 1001})
        for (const double off : {1e-3, 0.02, 0.1, 0.25, 1.0, 30.0})  // -a2/dx^2
            for (const double curve : {0.0, 1e-4, 0.02, 0.2}) {      // a4/dx^4
                const double h = 1.0 / N;
                const Grid g{N, h};
                GridSolve solve(g, 1.01, -off * h * h, curve * h * h * h * h);
                std::vector<double> u(N + 17, 7.0), v(N + 1, 0.0);
                for (int l = 1; l < N; ++l)
                    v[l] = solve.input()[l] = std::sin(1.7 * l * l) + (l == N - 1 ? 3 : 0);
                solve(u.data());
                BandedFactor(g, 1.01, -off * h * h, curve * h * h * h * h).solve(v.data());
                (solve.terms() > 0 ? summed : factored) += 1;
                EXPECT_EQ(u[N], 0);
                for (int l = 1; l < N; ++l)
                    ASSERT_NEAR(u[l], v[l], solve.terms() > 0 ? 4e-15 : 0)
                        << N << " " << off << " " << curve << " node " << l;
                GridSolve positive(g, 1.01, 0.05 * h * h, 0);  // the theta scheme's sign
                EXPECT_EQ(positive.terms() > 0, N >= 40);
            }
    EXPECT_GT(summed, 100);
    EXPECT_GT(factored, 30);
}

TEST(GridWeights, BandedFactorInvertsItsMatrix) {
    const Grid g{30, 0.1};
    const double dx2 = g.dx * g.dx;
    for (double a4 : {0.0, 3e-4}) {
        const double a0 = 1.1, a2 = -0.02;
        std::vector<double> u(31, 0.0), v(33, 0.0), d(31, 0.0);
        for (int l = 1; l < 30; ++l) u[l] = std::sin(3.0 * l * l);
        for (int l = 1; l < 30; ++l) d[l] = (u[l + 1] - 2 * u[l] + u[l - 1]) / dx2;
        for (int l = 1; l < 30; ++l)
            v[l] = a0 * u[l] + a2 * d[l] + a4 * (d[l + 1] - 2 * d[l] + d[l - 1]) / dx2;
        BandedFactor(g, a0, a2, a4).solve(v.data());
        for (int l = 1; l < 30; ++l) EXPECT_NEAR(v[l], u[l], 1e-13);
    }
    EXPECT_THROW(BandedFactor(g, 1, 0.02, 0), Refusal);
}

// ---- Losses.

TEST(GridLoss, AConstantLawIsFittedExactlyAndTheMisfitOfC3IsReported) {
    Scene scene = with_damping(c3_free(), PolynomialDamping{2.5, 0, 0});
    const LossFit constant = fit_losses(scene.strings.front());
    EXPECT_NEAR(constant.sigma0, 2.5, 1e-12);
    EXPECT_EQ(constant.sigma1, 0);
    EXPECT_EQ(constant.sigma2, 0);
    EXPECT_LT(constant.misfit, 1e-12);
    const LossFit c3 = fit_losses(c3_free().strings.front());
    const Modes modes = modes_of(c3_free().strings.front(), 133);
    double worst = 0;
    for (int i = 0; i < 133; ++i)
        worst =
            std::max(worst, std::abs(c3.at(modes.beta[i] * modes.beta[i]) / modes.sigma[i] - 1));
    EXPECT_NEAR(c3.misfit, worst, 1e-12);
    EXPECT_LT(worst, 0.25);  // 0.61 without the fourth power
    for (const std::string& form : all)
        EXPECT_DOUBLE_EQ(fact(at(44100, form, lasting(c3_free(), 1e-3)), "loss_fit_misfit"),
                         c3.misfit);
}

TEST(GridLoss, TheFitIsTheLeastSquaresAmongCoefficientsThatAreNotNegative) {
    // 1/i: every octave weighs the same
    const auto square = [](const Modes& modes, double s0, double s1, double s2) {
        double sum = 0;
        for (int i = 0; i < modes.count(); ++i) {
            const double b2 = modes.beta[i] * modes.beta[i];
            sum += std::pow((s0 + (s1 + s2 * b2) * b2) / modes.sigma[i] - 1, 2) / (i + 1);
        }
        return sum;
    };
    const Damping laws[] = {PolynomialDamping{0.6, 6.5e-3, 5e-6}, PolynomialDamping{0, 0, 5e-6},
                            PolynomialDamping{0.1, 0.1, 0}, PolynomialDamping{0, 1e-3, 0},
                            QualityFactorDamping{4.3e-4, 1.8e-5, 1.2, 0.003, 2e-4}};
    for (const Damping& law : laws) {
        const Scene scene = with_damping(c3_free(), law);
        const String& s = scene.strings.front();
        const Modes modes = modes_of(s, modes_below(s, 20e3));
        const LossFit fit = fit_losses(s);
        const double least = square(modes, fit.sigma0, fit.sigma1, fit.sigma2),
                     b2 = std::pow(modes.beta.back(), 2);
        const double steps[] = {1e-4 * modes.sigma.back(), 1e-4 * modes.sigma.back() / b2,
                                1e-4 * modes.sigma.back() / (b2 * b2)};
        for (int d = 0; d < 27; ++d) {  // convex: no better neighbour, no better fit
            const double s0 = fit.sigma0 + (d % 3 - 1) * steps[0],
                         s1 = fit.sigma1 + (d / 3 % 3 - 1) * steps[1],
                         s2 = fit.sigma2 + (d / 9 - 1) * steps[2];
            if (std::min({s0, s1, s2}) < 0) continue;
            EXPECT_GE(square(modes, s0, s1, s2), least * (1 - 1e-12)) << law.index() << " " << d;
        }
        EXPECT_GE(std::min({fit.sigma0, fit.sigma1, fit.sigma2}), 0);
    }
}

// What the fit alone costs, no grid in it: the exact solution under the fitted loss against that
// under the scene's, both with 133 modes.
TEST(GridLoss, TheFitMovesTheNutForceOfC3ByLessThanHalfAPercent) {
    Scene scene = c3_release();
    scene.duration = 0.05;
    const String& s = scene.strings.front();
    const Modes modes = modes_of(s, 133);
    const LossFit fit = fit_losses(s);
    TableDamping fitted{"fit", {}, {}};
    for (int i = 0; i < 133; ++i) {
        fitted.frequency_hz.push_back(modes.omega0[i] / (2 * pi));
        fitted.decay_rate.push_back(fit.at(modes.beta[i] * modes.beta[i]));
    }
    const Settings settings{0, 44100, 133, {}};
    const double error = apart(play("exact_contact", with_damping(scene, fitted), settings),
                               play("exact_contact", scene, settings), 0);
    EXPECT_LT(error, 5e-3);  // 2e-2 with two coefficients
}

// ---- Limits.

TEST(GridLimit, IsWhereTheHighestModeLeavesTheUnitCircle) {
    const String s = c3_free().strings.front();
    const LossFit loss = fit_losses(s);
    const double dt = 1 / 44100.0, limit = explicit_spacing_limit(s, loss, dt);
    // >= 0 where stable
    const auto margin = [&](double M, double K) { return M - 0.25 * dt * dt * K; };
    const auto K = [&](double lambda) {
        return (s.tension * lambda + s.bending_stiffness * lambda * lambda) / s.linear_density;
    };
    const double top = 4 / (limit * limit);
    EXPECT_GT(loss.sigma2 * dt * top * top, 1e-3);
    EXPECT_NEAR(margin(1 - (loss.sigma1 + loss.sigma2 * top) * dt * top, K(top)), 0, 1e-12);
    for (double theta : {0.6, 0.9}) {
        const double h = theta_spacing_limit(s, dt, theta);
        EXPECT_NEAR(margin(2 * theta - 1, K(4 / (h * h))), 0, 1e-12);
    }
    const double h = theta_spacing_limit(s, dt);
    EXPECT_NEAR(theta_spacing_limit(s, dt, tuned_theta(s, dt, h)), h, 1e-12);
}

TEST(GridLimit, OverItTheEnergyOfMotionExplodesAndTheRunSaysSo) {
    const Scene scene = lasting(c3_release(), 0.05);
    for (const std::string& form : {explicit_, theta_}) {
        const auto good = at(44100, form, scene), bad = at(44100, form + " over_limit=1.05", scene);
        EXPECT_EQ(good.status.outcome, Outcome::ok);
        EXPECT_EQ(bad.status.outcome, Outcome::diverged) << form;
        EXPECT_LT(bad.status.step, 2205);
        EXPECT_EQ(bad.trace.rows, bad.status.step);
        EXPECT_LT(fact(bad, "spacing_over_limit"), 1 / 1.05 + 1e-9);
        EXPECT_GE(fact(good, "spacing_over_limit"), 1);
        EXPECT_TRUE(std::isfinite(largest(bad.trace.column(1))));
    }
}

TEST(GridLimit, AGridOverItIsRefusedAndOneUnderItIsTaken) {
    Scene scene = lasting(c3_free(), 1e-3);
    const auto intervals = [&scene](const std::string& form) {
        return static_cast<int>(fact(at(44100, form, scene), "grid_intervals"));
    };
    for (const std::string& form : {explicit_, theta_}) {
        const int N = intervals(form);
        const auto of = [&form](int grid) { return form + " grid=" + std::to_string(grid); };
        EXPECT_EQ(intervals(of(N)), N);
        EXPECT_EQ(intervals(of(60)), 60);
        EXPECT_EQ(intervals(of(N + 2) + " over_limit=1.1"), N + 2);  // on purpose, and that far
        EXPECT_EQ(intervals(of(60) + " over_limit=1.1"), 60);
        for (const std::string& no : {of(N + 1), form + " grid=60.5", of(2 * N) + " over_limit=1.1",
                                      form + " over_limit=0.9", form + " mesh=1"})
            EXPECT_NE(refusal(no, scene, {44100, 44100, 0, {}}), "") << no;
    }
    EXPECT_EQ(intervals(hamiltonian_ + " grid=400"), 400);  // any
    scene.strings.front().barriers = {ProfileBarrier{FlatCurve{}, 1e-4, 2e-4, {1e9}, 1, 0}};
    EXPECT_NE(refusal(explicit_, scene, {44100, 44100, 0, {}}), "");  // between two nodes
}

// ---- Contact.

TEST(GridContact, ForceOfAProfileIsTheIntegralOfItsDensityOverTheString) {
    Scene scene = lossless(c3_free());
    scene.duration = 0.002;
    String& s = scene.strings.front();
    s.start = ModeShape{2, 1e-3};
    const double K = 1e5, from = 0.55, to = 0.9, slope = -2e-4;
    s.barriers = {ProfileBarrier{LineCurve{slope}, from, to, {K}, 1.5, 0}};
    scene.taps = {{"bridge", Quantity::bridge_force, 0, 0}};
    const int points = 400;
    for (int i = 0; i < points; ++i)
        scene.taps.push_back(
            {"y", Quantity::displacement, 0, from + (i + 0.5) * (to - from) / points});
    for (const std::string& form : all) {
        const auto r = at(88200, form, scene);
        const auto integral = [&](long n) {
            double sum = 0;
            for (int i = 0; i < points; ++i)
                sum += K *
                       std::pow(std::max(0.0, slope * scene.taps[i + 1].position -
                                                  r.trace.column(i + 1)[n]),
                                1.5) *
                       (to - from) / points;
            return sum;
        };
        for (long n : {1, 4, 8}) {
            const double want = 0.5 * (integral(n - 1) + integral(n));
            ASSERT_GT(want, 0.1);
            EXPECT_NEAR(r.trace.column(0)[n], want, 0.01 * want) << form << " " << n;
        }
    }
}

TEST(GridContact, AProfileThatEndsOnANodeHasIt) {  // whatever the rounding of both
    int missed = 0, tried = 0;
    for (const double length : {0.8, 1.0, 1.002, 0.65, 0.333})
        for (int intervals = 7; intervals < 300; intervals += 4)
            for (int node = 1; node < intervals; node += 3) {
                ProfileBarrier b;
                b.to = length * node / intervals;
                const auto nodes = nodes_on(b, length, intervals);
                missed += nodes.first != 1 || static_cast<int>(nodes.x.size()) != node ||
                          nodes.x.back() > b.to;
                b.from = b.to;
                b.to = length;
                const auto rest = nodes_on(b, length, intervals);  // the string's end is none
                missed += rest.first != node ||
                          static_cast<int>(rest.x.size()) != intervals - node ||
                          rest.x.front() < b.from;
                ++tried;
            }
    EXPECT_GT(tried, 3000);
    EXPECT_EQ(missed, 0);

    Scene scene = c3_free();
    scene.duration = 1e-3;
    scene.strings.front().length = 0.8;
    scene.strings.front().barriers = {ProfileBarrier{FlatCurve{}, 0, 0.08, {5e8}, 1, 0}};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}};
    for (const std::string& form : all)
        EXPECT_EQ(fact(at(176400, form + " grid=150", scene), "contact_points"), 15) << form;
}

TEST(GridContact, ManyCoupledPointsAreToldAndTooManyRefused) {
    Scene scene = c3_free();
    scene.duration = 1e-3;
    scene.strings.front().barriers = {ProfileBarrier{FlatCurve{}, 0, 0.5, {5e8}, 1, 0}};
    EXPECT_EQ(fact(at(44100, theta_ + " grid=50", scene), "coupled_contact_points"), 25);
    scene.strings.front().bending_stiffness = 0;
    EXPECT_NE(refusal(explicit_ + " grid=20000", scene, {44100 * 256, 44100, 0, {}}), "");
}

TEST(GridContact, MomentumOfTheStringIsTheImpulseOfAllForces) {
    // A light string without tension or stiffness to speak of: the thread's mean force is the rate
    // of the momentum.
    for (const std::string& form : all) {
        Scene scene = lossless(c3_free());
        String& s = scene.strings.front();
        s.tension = 1e-3;
        s.bending_stiffness = 0;
        s.start = ModeShape{1, 1e-3};
        s.thread = Thread{0.5, 1.0, 50, 0, 0};
        scene.duration = 0.004;
        scene.taps = {{"thread", Quantity::thread_force, 0, 0}};
        for (int l = 1; l < 200; ++l) scene.taps.push_back({"v", Quantity::velocity, 0, l / 200.0});
        const auto r = at(44100, form + " grid=200", scene, 4410);
        double impulse = 0, momentum = 0;
        for (double f : r.trace.column(0)) impulse += f / 4410;
        for (int k = 1; k < 200; ++k)
            momentum += s.linear_density / 200 * r.trace.column(k)[r.trace.rows - 1];
        EXPECT_NEAR(momentum, impulse, 2e-3 * std::abs(impulse)) << form;
    }
}

}  // namespace
}  // namespace jvari
