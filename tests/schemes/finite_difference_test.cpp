// Finite differences: weights on nodes, von Neumann relations against traces, order on linear
// strings, energy, stability limits, contact.
#include "schemes/grid/grid_solve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "reference/references.hpp"
#include "scenes/barrier.hpp"
#include "scenes/modes.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

using std::numbers::pi;

const char* const all[] = {"finite_difference_explicit", "finite_difference_theta",
                           "finite_difference_hamiltonian"};
const char *const explicit_ = all[0], *const theta_ = all[1], *const hamiltonian_ = all[2];

using Options = std::vector<std::pair<std::string, std::string>>;

const Descriptor& scheme(const std::string& name) {
    for (const Descriptor& d : schemes())
        if (d.name == name) return d;
    throw std::runtime_error(name);
}

Run run_at(const std::string& name, const Scene& scene, double rate, Options options = {},
           double tap_rate = 0, bool energy = false, int modes = 0) {
    Settings settings;
    settings.sample_rate = rate;
    settings.tap_rate = tap_rate > 0 ? tap_rate : rate;
    settings.options = std::move(options);
    settings.modes = modes;
    RunOptions how;
    how.energy = energy;
    return run(scheme(name), scene, settings, how);
}

double fact(const Run& r, const std::string& name) {
    for (const Fact& f : r.facts)
        if (f.name == name) return f.value;
    throw std::runtime_error("no fact " + name);
}

Run exact(const Scene& scene, int modes) {
    Settings settings;
    settings.sample_rate = settings.tap_rate = 44100;
    settings.modes = modes;
    for (const Descriptor& d : references())
        if (d.name == std::string("exact_contact")) return run(d, scene, settings);
    throw std::runtime_error("exact_contact");
}

Scene with_damping(Scene scene, Damping damping) {
    scene.strings.front().damping = std::move(damping);
    return scene;
}

double difference(std::span<const double> a, std::span<const double> b) {  // relative L2
    double error = 0, size = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        error += (a[i] - b[i]) * (a[i] - b[i]);
        size += b[i] * b[i];
    }
    return std::sqrt(error / size);
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
    Scene scene2 = c3_free();
    scene2.duration = 0.001;
    for (const char* name : all)
        EXPECT_DOUBLE_EQ(fact(run_at(name, scene2, 44100), "loss_fit_misfit"), c3.misfit);
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
        std::printf("[ measured ] sigma0 %.3e sigma1 %.3e sigma2 %.3e misfit %.2f\n", fit.sigma0,
                    fit.sigma1, fit.sigma2, fit.misfit);
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
    const auto truth = exact(scene, 133), moved = exact(with_damping(scene, fitted), 133);
    const double error = difference(moved.trace.column(0), truth.trace.column(0));
    std::printf("[ measured ] nut force, 0-50 ms: %.2e\n", error);
    EXPECT_LT(error, 5e-3);  // 2e-2 with two coefficients
}

// ---- Von Neumann.

// at 44100 Hz
FreeMode predicted(const std::string& name, const Scene& scene, int mode, Options options = {}) {
    return make_scheme(scheme(name), scene, {44100, 44100, 0, std::move(options)})
        ->free_modes()
        .at(mode - 1);
}

TEST(GridModes, FrequenciesAndDecayOfTracesFollowTheVonNeumannRelationOfEachScheme) {
    const double dt = 1 / 44100.0;
    double worst_cents = 0;
    for (const char* name : all) {
        for (const Scene& base : {lossless(c3_free()), c3_free()}) {
            Scene scene = base;
            scene.duration = 0.02;
            for (int mode = 1; mode <= 30; ++mode) {
                scene.strings.front().initial = ModeInitial{mode, 1e-3};
                const auto r = run_at(name, scene, 44100);
                const FreeMode want = predicted(name, scene, mode);
                // displacement at 0.3 m; a node of modes 10, 20, 30
                const auto y = r.trace.column(1);
                if (mode % 10 == 0) continue;
                // y_{n+1} = p y_n - q y_{n-1}, least squares
                long double a = 0, b = 0, c = 0, d = 0, e = 0;
                for (std::size_t n = 2; n + 1 < y.size(); ++n) {
                    a += y[n] * y[n];
                    b -= y[n] * y[n - 1];
                    c += y[n - 1] * y[n - 1];
                    d += y[n + 1] * y[n];
                    e -= y[n + 1] * y[n - 1];
                }
                const long double det = a * c - b * b, p = (d * c - e * b) / det,
                                  q = (a * e - b * d) / det;
                const double omega = static_cast<double>(std::acos(p / (2 * std::sqrt(q)))) / dt,
                             sigma = static_cast<double>(-0.5L * std::log(q)) / dt;
                const double cents = 1200 * std::log2(omega / want.omega);
                worst_cents = std::max(worst_cents, std::abs(cents));
                EXPECT_LT(std::abs(cents), 1e-3) << name << " mode " << mode;
                EXPECT_NEAR(sigma, want.sigma, 1e-4 * want.sigma + 1e-4)
                    << name << " mode " << mode;
            }
        }
    }
    std::printf("[ measured ] worst of modes 1..30: %.1e cents\n", worst_cents);
}

TEST(GridModes, ALosslessModeIsTheSchemesOwnCosineFromTheFirstSample) {
    Scene scene = lossless(c3_free());
    scene.duration = 0.05;
    for (const char* name : all) {
        for (int mode : {1, 7, 23}) {
            scene.strings.front().initial = ModeInitial{mode, 1e-3};
            const auto r = run_at(name, scene, 44100);
            const double omega = predicted(name, scene, mode).omega;
            const auto y = r.trace.column(1);
            for (std::size_t n = 0; n < y.size(); ++n)
                ASSERT_NEAR(y[n], y[0] * std::cos(omega * n / 44100), 1e-9 * 1e-3)
                    << name << " " << n;
        }
    }
}

TEST(GridModes, MidpointFrequenciesWarpByTheArcTangent) {
    const Scene scene = lossless(c3_free());
    const String& s = scene.strings.front();
    const double dt = 1 / 44100.0;
    for (int i : {1, 50, 154}) {
        const double lambda = std::pow(2 * 155 / s.length * std::sin(0.5 * pi * i / 155), 2);
        const double omega = std::sqrt(
            (s.tension * lambda + s.bending_stiffness * lambda * lambda) / s.linear_density);
        EXPECT_NEAR(predicted(hamiltonian_, scene, i, {{"grid", "155"}}).omega,
                    2 / dt * std::atan(omega * dt / 2), 1e-9 * omega);
    }
}

TEST(GridModes, TheTunedThetaLeavesFarLessDispersionThanTheExplicitScheme) {
    const Scene scene = lossless(c3_free());
    const Modes exact = modes_of(scene.strings.front(), 60);
    for (int i : {20, 60}) {
        const double of_explicit =
            1200 * std::log2(predicted(explicit_, scene, i).omega / exact.omega0[i - 1]);
        const double of_theta =
            1200 * std::log2(predicted(theta_, scene, i).omega / exact.omega0[i - 1]);
        std::printf("[ measured ] mode %d: explicit %.2f cents, theta %.3f cents\n", i, of_explicit,
                    of_theta);
        EXPECT_LT(std::abs(of_theta), std::abs(of_explicit) / (i < 50 ? 20 : 4));
    }
}

// ---- Order on linear strings.

// Exact motion of modes released at rest: y_i = a_i exp(-sigma t)(cos omega t + sigma/omega sin
// omega t).
struct Exact {
    Modes modes;
    std::vector<double> a;
    double at(const std::vector<double>& weights, double t, bool velocity) const {
        double sum = 0;
        for (int i = 0; i < modes.count(); ++i) {
            const double s = modes.sigma[i],
                         w = std::sqrt(omega_squared_damped(modes.omega0[i], s)),
                         o = modes.omega0[i];
            const double motion =
                velocity ? -o * o / w * std::sin(w * t) : std::cos(w * t) + s / w * std::sin(w * t);
            sum += weights[i] * a[i] * std::exp(-s * t) * motion;
        }
        return sum;
    }
};

// stiffness low enough that dt and dx can be halved together within the explicit limit
Scene smooth_string() {
    Scene scene = with_damping(c3_free(), PolynomialDamping{3, 0, 0});
    scene.duration = 0.01;
    String& s = scene.strings.front();
    s.bending_stiffness = 1e-5;
    s.initial = TriangleInitial{0.37, 1e-3, 0.4};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0},
                  {"y", Quantity::displacement, 0, 0.2718},
                  {"v", Quantity::velocity, 0, 0.2718}};
    return scene;
}

TEST(GridOrder, LinearStringsConvergeAtOrderTwoToTheExactSolution) {
    const Scene scene = smooth_string();
    const String& s = scene.strings.front();
    Exact exact{modes_of(s, 60), {}};
    exact.a = initial_displacement(exact.modes, s);
    const std::vector<double> weights[] = {nut_force_weights(exact.modes, s),
                                           displacement_weights(exact.modes, 0.2718),
                                           displacement_weights(exact.modes, 0.2718)};
    for (const char* name : all) {
        double last[3] = {};
        for (int refine : {1, 2, 4}) {
            Options options = {{"grid", std::to_string(100 * refine)}};
            // the tuned one is of higher order where stiffness is small
            if (name == theta_) options.push_back({"theta", "0.8"});
            const auto r = run_at(name, scene, 44100.0 * refine, options, 44100);
            ASSERT_EQ(r.status.outcome, Outcome::ok);
            for (int k = 0; k < 3; ++k) {
                std::vector<double> want;
                for (long n = 0; n < r.trace.rows; ++n)
                    want.push_back(exact.at(weights[k], n / 44100.0, k == 2));
                const double error = difference(r.trace.column(k), want);
                if (refine > 1) {
                    const double order = std::log2(last[k] / error);
                    EXPECT_NEAR(order, 2.0, 0.1)
                        << name << " " << r.trace.names[k] << " x" << refine;
                    std::printf("[ measured ] %s %s x%d: error %.2e, order %.3f\n", name,
                                r.trace.names[k].c_str(), refine, error, order);
                }
                last[k] = error;
            }
        }
    }
}

TEST(GridOrder, ThetaAtItsTunedValueIsFarCloserThanAtOthers) {
    const Scene scene = smooth_string();
    const String& s = scene.strings.front();
    Exact exact{modes_of(s, 60), {}};
    exact.a = initial_displacement(exact.modes, s);
    const auto w = displacement_weights(exact.modes, 0.2718);
    const auto error = [&](Options options) {
        const auto r = run_at(theta_, scene, 44100, options);
        std::vector<double> want;
        for (long n = 0; n < r.trace.rows; ++n) want.push_back(exact.at(w, n / 44100.0, false));
        return difference(r.trace.column(1), want);
    };
    const double tuned = error({{"grid", "100"}}),
                 other = error({{"grid", "100"}, {"theta", "0.8"}});
    std::printf("[ measured ] tuned %.1e, theta = 0.8 %.1e\n", tuned, other);
    EXPECT_LT(tuned, other / 30);
}

TEST(GridOrder, AStringPluckedByAForceConvergesAtOrderTwo) {
    Scene scene = smooth_string();
    String& s = scene.strings.front();
    s.initial.reset();
    s.pluck = Pluck{-0.4, 6e-3, 4.0, 0.5e-3, 0.31, 0.3};
    const auto truth = run_at("modal_two_point", scene, 64 * 44100.0, {}, 44100, false, 80);
    for (const char* name : all) {
        double last = 0;
        for (int refine : {1, 2, 4}) {
            Options options = {{"grid", std::to_string(100 * refine)}};
            if (name == theta_) options.push_back({"theta", "0.8"});
            const double error =
                difference(run_at(name, scene, 44100.0 * refine, options, 44100).trace.column(1),
                           truth.trace.column(1));
            if (refine > 1) {
                EXPECT_NEAR(std::log2(last / error), 2.0, 0.1) << name << " " << error;
            }
            last = error;
        }
    }
}

TEST(GridOrder, ASoftThreadAndABarrierNeverLeftKeepOrderTwoFromTheFirstStep) {
    Scene scene = smooth_string();
    String& s = scene.strings.front();
    s.thread = Thread{0.31, 0.3, 300, 0.1, 0.2e-3};
    s.barriers = {LumpedBarrier{0.62, 0.4, 3e-3, {1e3}, 1.5, 0}};
    scene.taps.push_back({"thread", Quantity::thread_force, 0, 0});
    scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    const auto truth = run_at("modal_two_point", scene, 64 * 44100.0, {}, 44100, false, 80);
    for (long n = 1; n < truth.trace.rows; ++n) ASSERT_GT(truth.trace.column(4)[n], 0);
    for (const char* name : all) {
        double last[5] = {};
        for (int refine : {1, 2, 4}) {
            Options options = {{"grid", std::to_string(100 * refine)}};
            if (name == theta_) options.push_back({"theta", "0.8"});
            const auto r = run_at(name, scene, 44100.0 * refine, options, 44100);
            // the footprint's kinks make the velocity less regular than order two needs
            for (int k : {1, 3, 4}) {
                const double error = difference(r.trace.column(k), truth.trace.column(k));
                if (refine > 1) {
                    EXPECT_NEAR(std::log2(last[k] / error), 2.0, 0.1)
                        << name << " " << r.trace.names[k] << " " << error;
                }
                last[k] = error;
            }
        }
    }
}

// ---- Energy.

double worst_residual(const Run& r) {  // per row, relative to the largest stored energy
    double worst = 0, largest = 0;
    const auto stored = r.trace.energy_column(0), supplied = r.trace.energy_column(1),
               dissipated = r.trace.energy_column(2);
    for (long n = 1; n < r.trace.rows; ++n) {
        worst = std::max(worst, std::abs(stored[n] - stored[n - 1] - supplied[n] + dissipated[n]));
        largest = std::max(largest, stored[n]);
    }
    return worst / largest;
}

// two lumped barriers of other exponents, a profile, a thread, a pluck: everything a string on a
// grid can carry
Scene crowded() {
    Scene scene = c3_pluck();
    String& s = scene.strings.front();
    s.initial = ModeInitial{1, 1.9e-3};
    s.barriers = {LumpedBarrier{10e-3, 2e-3, 0, {4.39e8}, 1.3, 0},
                  LumpedBarrier{14e-3, 30e-3, -1e-6, {1e9}, 1.5, 0},
                  ProfileBarrier{ParabolaCurve{0.1}, 0.02, 0.12, {1e10}, 1.0, 0}};
    scene.taps.push_back({"drive", Quantity::driving_force, 0, 0});
    return scene;
}

TEST(GridEnergy, BalancesAtEveryStepWithAndWithoutLosses) {
    for (const char* name : all) {
        for (Scene scene :
             {lossless(c3_release()), c3_release(), c3_pluck(), lossless(crowded()), crowded()}) {
            scene.duration = 0.02;
            const auto r = run_at(name, scene, 44100, {}, 0, true);
            ASSERT_EQ(r.status.outcome, Outcome::ok) << name;
            EXPECT_LT(worst_residual(r), 1e-11) << name;
            EXPECT_GE(fact(r, "smallest_contact_force"), 0);
            for (double d : r.trace.energy_column(2)) ASSERT_GE(d, 0);
            std::printf(
                "[ measured ] %s: residual %.1e, penetration %.1e m, iterations at most %.0f\n",
                name, worst_residual(r), fact(r, "deepest_penetration"),
                fact(r, "contact_iterations_most"));
            if (scene.taps.size() < 5) continue;
            // the crowded one: driving = -(bridge + thread)
            for (long n = 0; n < r.trace.rows; ++n)
                ASSERT_NEAR(r.trace.column(4)[n], -(r.trace.column(2)[n] + r.trace.column(3)[n]),
                            1e-12);
        }
    }
}

TEST(GridEnergy, NoSpringToTheGroundIsLeftOfRoundedCoefficients) {
    // At 2.8 MHz the stiffness of mode 1 is 2e-8 of the coefficients it is the difference of: a sum
    // of them that is not 0 but one rounding lets the energy of the midpoint scheme waver by
    // 1.3e-9.
    Scene scene = lossless(c3_free());
    scene.strings.front().initial = ModeInitial{1, 1e-3};
    scene.duration = 2e-3;
    const auto r = run_at(hamiltonian_, scene, 44100.0 * 64, {}, 44100, true);
    const auto stored = r.trace.energy_column(0);
    double most = 0;
    for (long n = 1; n < r.trace.rows; ++n)
        most = std::max(most, std::abs(stored[n] / stored[0] - 1));
    EXPECT_LT(most, 1e-10);
}

TEST(GridEnergy, OfASlowStringIsNotLostInAnIllConditionedSolve) {
    // Waves of 9.5 m/s on 18000 nodes, and a loss in space that makes the matrix 1e4 times larger
    // than its smallest eigenvalue. Solved for u+ and not for u+ - u-, the theta scheme's rows are
    // open by 1e-9.
    Scene scene = c3_free();
    String& s = scene.strings.front();
    s.linear_density = 1.9e-3;
    s.tension = 0.17;
    s.bending_stiffness = 0;
    s.damping = PolynomialDamping{3.2, 3.9e-3, 8e-6};
    s.initial = ModeInitial{4, 2e-4};
    scene.duration = 5e-4;
    for (const char* name : {theta_, hamiltonian_})
        EXPECT_LT(worst_residual(run_at(name, scene, 4 * 44100, {}, 44100, true)), 1e-11) << name;
}

TEST(GridEnergy, OfAFreeModeIsThatOfTheContinuousString) {
    Scene scene = lossless(c3_free());
    scene.duration = 0.005;
    scene.strings.front().initial = ModeInitial{3, 1e-3};
    const Modes m = modes_of(scene.strings.front(), 3);
    const double want = 0.5 * m.mass * std::pow(m.omega0[2] * 1e-3, 2);
    const double second_order = 0.5 * std::pow(m.omega0[2] / 44100, 2);
    for (const char* name : all) {
        const auto r = run_at(name, scene, 44100, {}, 0, true);
        for (double stored : r.trace.energy_column(0))
            ASSERT_NEAR(stored, want, second_order * want) << name;
    }
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
    Scene scene = c3_release();
    scene.duration = 0.05;
    for (const char* name : {explicit_, theta_}) {
        const auto good = run_at(name, scene, 44100, {}, 0, true),
                   bad = run_at(name, scene, 44100, {{"over_limit", "1.05"}}, 0, true);
        EXPECT_EQ(good.status.outcome, Outcome::ok);
        EXPECT_EQ(bad.status.outcome, Outcome::diverged) << name;
        EXPECT_LT(bad.status.step, 2205);
        EXPECT_EQ(bad.trace.rows, bad.status.step);
        EXPECT_LT(fact(bad, "spacing_over_limit"), 1 / 1.05 + 1e-9);
        EXPECT_GE(fact(good, "spacing_over_limit"), 1);
        double peak = 0;
        for (double y : bad.trace.column(1)) peak = std::max(peak, std::abs(y));
        EXPECT_TRUE(std::isfinite(peak));
    }
}

TEST(GridLimit, AGridOverItIsRefusedAndOneUnderItIsTaken) {
    Scene scene = c3_free();
    scene.duration = 0.001;
    for (const char* name : {explicit_, theta_}) {
        const int N = static_cast<int>(fact(run_at(name, scene, 44100), "grid_intervals"));
        EXPECT_THROW(run_at(name, scene, 44100, {{"grid", std::to_string(N + 1)}}), Refusal);
        EXPECT_EQ(fact(run_at(name, scene, 44100, {{"grid", std::to_string(N)}}), "grid_intervals"),
                  N);
        EXPECT_EQ(fact(run_at(name, scene, 44100, {{"grid", "60"}}), "grid_intervals"), 60);
        EXPECT_THROW(run_at(name, scene, 44100, {{"grid", "60.5"}}), Refusal);
        const auto past = [&](int grid) {
            return run_at(name, scene, 44100,
                          {{"grid", std::to_string(grid)}, {"over_limit", "1.1"}});
        };
        EXPECT_EQ(fact(past(N + 2), "grid_intervals"), N + 2);  // on purpose, and that far
        EXPECT_EQ(fact(past(60), "grid_intervals"), 60);
        EXPECT_THROW(past(2 * N), Refusal);
        EXPECT_THROW(run_at(name, scene, 44100, {{"over_limit", "0.9"}}), Refusal);
        EXPECT_THROW(run_at(name, scene, 44100, {{"mesh", "1"}}), Refusal);
    }
    // any
    EXPECT_EQ(fact(run_at(hamiltonian_, scene, 44100, {{"grid", "400"}}), "grid_intervals"), 400);
    scene.strings.front().barriers = {ProfileBarrier{FlatCurve{}, 1e-4, 2e-4, {1e9}, 1, 0}};
    EXPECT_THROW(run_at(explicit_, scene, 44100), Refusal);  // between two nodes
}

TEST(GridLimit, NoThreadIsTooStiff) {
    Scene scene = lossless(c3_release());
    scene.duration = 0.02;
    scene.strings.front().thread->stiffness = 1e10;
    for (const char* name : all) {
        const auto r = run_at(name, scene, 44100, {}, 0, true);
        EXPECT_EQ(r.status.outcome, Outcome::ok) << name;
        EXPECT_LT(worst_residual(r), 1e-11) << name;
        // the string's own energy is 1e-4 of this
        const double y = 1.9e-3 * std::sin(pi * 5e-3), start = 0.5 * 1e10 * y * y;
        EXPECT_NEAR(r.trace.energy_column(0)[0], start, 0.02 * start) << name;
    }
}

// ---- Contact.

TEST(GridContact, ApproachesTheModalSolutionAsTheRateRises) {
    // a loss that the grid can follow
    Scene scene = with_damping(c3_release(), PolynomialDamping{5, 0, 0});
    scene.duration = 0.008;
    const auto truth = run_at("modal_two_point", scene, 32 * 44100.0, {}, 44100, false, 900);
    for (const char* name : all) {
        double last = 1;
        for (int times : {1, 4, 16}) {
            const auto r = run_at(name, scene, times * 44100.0, {}, 44100);
            const double y = difference(r.trace.column(1), truth.trace.column(1));
            std::printf("[ measured ] %s x%d: y03 %.2e, bridge %.2e, thread %.2e\n", name, times, y,
                        difference(r.trace.column(2), truth.trace.column(2)),
                        difference(r.trace.column(3), truth.trace.column(3)));
            EXPECT_LT(y, last);
            last = y;
        }
        EXPECT_LT(last, 1.5e-3) << name;
    }
}

// The string of the paper's Table 1 with its own loss law, against the exact solution. A grid
// carries every mode it can hold, so the reference has enough modes for the rest not to count: its
// nut force with 133 modes, those below 20 kHz, is 2.2e-2 off (0-50 ms). What is left at any rate
// is the fit of the loss, 3e-3 (above). The whole series, to x64 and 50 ms, is in
// results/README.md.
TEST(GridContact, OnC3TheNutForceApproachesTheExactSolutionAsTheRateRises) {
    Scene scene = c3_release();
    scene.duration = 0.02;
    const auto truth = exact(scene, 300);
    for (const char* name : all) {
        double last = 1;
        for (int times : {1, 4, 16}) {
            const auto r = run_at(name, scene, times * 44100.0, {}, 44100);
            const double error = difference(r.trace.column(0), truth.trace.column(0));
            std::printf("[ measured ] %s x%d: nut force %.2e\n", name, times, error);
            EXPECT_LT(error, 0.85 * last) << name << " x" << times;
            last = error;
        }
        EXPECT_LT(last, name == theta_ ? 1.2e-2 : 6e-2) << name;
    }
}

TEST(GridContact, ForceOfARowIsTheMeanOverItsIntervalAtAnyTapRate) {
    Scene scene = c3_release();
    scene.duration = 0.01;
    for (const char* name : all) {
        const auto fine = run_at(name, scene, 88200),
                   coarse = run_at(name, scene, 88200, {}, 22050);
        for (int k : {2, 3})
            for (long n = 1; n < coarse.trace.rows && 4 * n < fine.trace.rows; ++n) {
                double mean = 0;
                for (int i = 0; i < 4; ++i) mean += fine.trace.column(k)[4 * n - i] / 4;
                ASSERT_NEAR(coarse.trace.column(k)[n], mean, 1e-12 + 1e-12 * std::abs(mean))
                    << name;
            }
        EXPECT_EQ(coarse.trace.column(2)[0], 0);
        EXPECT_EQ(coarse.trace.column(3)[0], 0);
    }
}

TEST(GridContact, ForceOfAProfileIsTheIntegralOfItsDensityOverTheString) {
    Scene scene = lossless(c3_free());
    scene.duration = 0.002;
    String& s = scene.strings.front();
    s.initial = ModeInitial{2, 1e-3};
    const double K = 1e5, from = 0.55, to = 0.9, slope = -2e-4;
    s.barriers = {ProfileBarrier{LineCurve{slope}, from, to, {K}, 1.5, 0}};
    scene.taps = {{"bridge", Quantity::bridge_force, 0, 0}};
    const int points = 400;
    for (int i = 0; i < points; ++i)
        scene.taps.push_back(
            {"y", Quantity::displacement, 0, from + (i + 0.5) * (to - from) / points});
    for (const char* name : all) {
        const auto r = run_at(name, scene, 88200);
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
            EXPECT_NEAR(r.trace.column(0)[n], want, 0.01 * want) << name << " " << n;
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
    for (const char* name : all)
        EXPECT_EQ(fact(run_at(name, scene, 176400, {{"grid", "150"}}), "contact_points"), 15)
            << name;
}

TEST(GridContact, ManyCoupledPointsAreToldAndTooManyRefused) {
    Scene scene = c3_free();
    scene.duration = 1e-3;
    scene.strings.front().barriers = {ProfileBarrier{FlatCurve{}, 0, 0.5, {5e8}, 1, 0}};
    EXPECT_EQ(fact(run_at(theta_, scene, 44100, {{"grid", "50"}}), "coupled_contact_points"), 25);
    scene.strings.front().bending_stiffness = 0;
    EXPECT_THROW(run_at(explicit_, scene, 44100 * 256, {{"grid", "20000"}}), Refusal);
}

TEST(GridContact, MomentumOfTheStringIsTheImpulseOfAllForces) {
    // A light string without tension or stiffness to speak of: the thread's mean force is the rate
    // of the momentum.
    for (const char* name : all) {
        Scene scene = lossless(c3_free());
        String& s = scene.strings.front();
        s.tension = 1e-3;
        s.bending_stiffness = 0;
        s.initial = ModeInitial{1, 1e-3};
        s.thread = Thread{0.5, 1.0, 50, 0, 0};
        scene.duration = 0.004;
        scene.taps = {{"thread", Quantity::thread_force, 0, 0}};
        for (int l = 1; l < 200; ++l) scene.taps.push_back({"v", Quantity::velocity, 0, l / 200.0});
        const auto r = run_at(name, scene, 44100, {{"grid", "200"}}, 4410);
        double impulse = 0, momentum = 0;
        for (double f : r.trace.column(0)) impulse += f / 4410;
        for (int k = 1; k < 200; ++k)
            momentum += s.linear_density / 200 * r.trace.column(k)[r.trace.rows - 1];
        EXPECT_NEAR(momentum, impulse, 2e-3 * std::abs(impulse)) << name;
    }
}

// ---- The seam.

TEST(GridString, TracesDependNeitherOnTheBlockNorOnTheEnergyProbe) {
    Scene scene = crowded();
    scene.duration = 0.005;
    Scene two = scene;
    two.strings.push_back(c3_release().strings.front());
    two.taps = {{"drive", Quantity::driving_force, {}, 0},
                {"first", Quantity::driving_force, 0, 0},
                {"second", Quantity::driving_force, 1, 0}};
    for (const char* name : all) {
        Settings settings;
        settings.sample_rate = 88200;
        settings.tap_rate = 44100;
        RunOptions odd;
        odd.block_rows = 7;
        odd.energy = true;
        const auto a = run(scheme(name), scene, settings),
                   b = run(scheme(name), scene, settings, odd);
        EXPECT_EQ(a.trace.tap, b.trace.tap) << name;
        const auto made = make_scheme(scheme(name), scene, settings);
        for (int again = 0; again < 2; ++again)
            // reset() is complete
            EXPECT_EQ(run(*made, scene, settings).trace.tap, a.trace.tap) << name;
        const auto both = run(scheme(name), two, settings);
        EXPECT_EQ(both.dofs, 2 * a.dofs);
        for (long n = 0; n < both.trace.rows; ++n)
            ASSERT_DOUBLE_EQ(both.trace.column(0)[n],
                             both.trace.column(1)[n] + both.trace.column(2)[n]);
    }
}

// ---- Contacts that lose energy.

Scene losing(double beta) {
    Scene s = c3_release();
    s.duration = 0.01;
    std::get<LumpedBarrier>(s.strings[0].barriers[0]).contact_loss = beta;
    return s;
}

TEST(ContactLossOnAGrid, IsInTheLedgerAndOfItsSize) {
    for (const char* name : {"finite_difference_explicit", "finite_difference_theta",
                             "finite_difference_hamiltonian"}) {
        const auto left = [name](double beta) {
            const Scene s = lossless(losing(beta));
            const jvari::Run r = run(scheme(name), s, {176400, 176400, 0, {}}, {.energy = true});
            const auto stored = r.trace.energy_column(0), dissipated = r.trace.energy_column(2);
            for (long n = 1; n < r.trace.rows; ++n)
                EXPECT_NEAR(stored[n], stored[n - 1] - dissipated[n], 1e-12 * stored[0])
                    << name << " " << beta << " " << n;
            return stored[r.trace.rows - 1] / stored[0];
        };
        EXPECT_NEAR(left(0), 1, 1e-9) << name;
        EXPECT_LT(left(0.5), 1 - 1e-4) << name;
        EXPECT_THROW(
            make_scheme(scheme(name), losing(5), {176400, 44100, 0, {{"compliance", "matched"}}}),
            Refusal)
            << name;
    }
}

// A string falls on a broad soft obstacle, which takes more than half of its energy in 20 ms.
// Three-point steps take the loss at the level that they are centred on, the midpoint rule at the
// older one.
TEST(ContactLossOnAGrid, ConvergesToTheExactSolutionAtOrderTwoInThreePointStepsAndOneInTwo) {
    Scene s = lossless(c3_free());
    s.duration = 0.02;
    s.strings[0].initial = ModeInitial{1, 1.9e-3};
    s.strings[0].barriers = {LumpedBarrier{0.4, 0.2, -5e-4, {1e7}, 1.5, 2}};
    s.taps = {{"bridge", Quantity::bridge_force, 0, 0}};
    const auto left = [](const jvari::Run& r) {
        return r.trace.energy_column(0)[r.trace.rows - 1] / r.trace.energy_column(0)[0];
    };
    const auto exact = std::ranges::find_if(
        references(), [](const Descriptor& d) { return std::string("exact_contact") == d.name; });
    const jvari::Run truth = run(*exact, s, {0, 44100, 300, {}}, {.energy = true});
    ASSERT_EQ(truth.status.outcome, Outcome::ok);
    EXPECT_LT(left(truth), 0.5);
    for (const char* name : all) {
        std::vector<double> error;
        for (const int rate : {4, 16}) {
            const jvari::Run r =
                run(scheme(name), s, {44100.0 * rate, 44100, 0, {}}, {.energy = true});
            error.push_back(relative_difference(r.trace.column(0), truth.trace.column(0)));
            EXPECT_NEAR(left(r), left(truth), 0.02 / rate) << name;
        }
        const double order = std::log2(error[0] / error[1]) / 2;
        if (std::string(name) == "finite_difference_hamiltonian")
            EXPECT_NEAR(order, 1, 0.1) << error[0] << " " << error[1];
        else EXPECT_NEAR(order, 1.9, 0.3) << name << " " << error[0] << " " << error[1];
    }
}

}  // namespace
}  // namespace jvari
