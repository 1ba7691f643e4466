// The event-driven reference against closed forms, dense linear algebra, a brute-force integrator
// and itself.
#include <gsl/gsl_integration.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "reference/exact/springs.hpp"
#include "reference/gauss_legendre.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/start.hpp"
#include "tests/c3.hpp"
#include "tests/claims.hpp"

namespace jvari {
namespace {

using std::numbers::pi;

Scene c3(bool losses = true) {
    Scene scene = lasting(losses ? c3_release() : lossless(c3_release()), 0.02);
    scene.taps.push_back({"v", Quantity::velocity, 0, 0.3});
    scene.taps.push_back({"drive", Quantity::driving_force, 0, 0});
    return scene;
}

// Few modes, two soft barriers at different heights, a thread off its height, losses and a pluck:
// everything at once.
Scene few_modes() {
    Scene scene = c3();
    String& s = scene.strings[0];
    s.damping = PolynomialDamping{3, 0.5, 0};
    s.barriers = {LumpedBarrier{0.15, 2e-3, -3e-4, {4e5}, 1, 0},
                  LumpedBarrier{0.62, 0, -5e-4, {2e5}, 1, 0}};
    s.thread = Thread{0.05, 1e-3, 3e3, 0.05, 1e-5};
    s.pluck = Pluck{-0.3, 3e-3, 12, 0.4e-3, 0.4, 0.02};
    scene.duration = 0.01;
    return scene;
}

Settings settings(int modes, const char* tolerance = "1e-12") {
    Settings s;
    s.modes = modes;
    s.options = {{"tolerance", tolerance}};
    return s;
}

TEST(GaussLegendre, IntegratesEveryPolynomialThatItCanAndNoOther) {
    for (int n = 1; n <= 16; ++n) {
        std::vector<double> node(n), weight(n);
        gauss_legendre(node, weight);
        const auto relative = [&](int power) {  // of int_0^1 x^power dx
            long double sum = 0;
            for (int q = 0; q < n; ++q)
                sum += weight[q] * std::pow(static_cast<long double>(node[q]), power);
            return static_cast<double>(sum * (power + 1) - 1);
        };
        for (int power = 0; power < 2 * n; ++power)
            EXPECT_LT(std::abs(relative(power)), 1.2e-16 * (power + 2)) << n << " " << power;
        double missed = 1;  // n!^4/(2n)!^2
        for (int k = 1; k <= n; ++k) missed *= std::pow(k / (2.0 * (2 * k - 1)), 2);
        EXPECT_NEAR(relative(2 * n), -missed, 1e-3 * missed + 5e-15) << n;
    }
}

TEST(GaussLegendre, NodesAndWeightsAreRightToTheirLastBitButOneAndMirrorImages) {
    for (int n = 1; n <= 64; ++n) {
        std::vector<double> node(n), weight(n);
        gauss_legendre(node, weight);
        for (int q = 0; q < n; ++q) {
            EXPECT_NEAR(node[q] + node[n - 1 - q], 1, 1.2e-16) << n;
            EXPECT_EQ(weight[q], weight[n - 1 - q]) << n;
            const long double x = 2 * static_cast<long double>(node[q]) - 1,
                              p = std::legendre(n, x), before = std::legendre(n - 1, x);
            const long double slope = n * (x * p - before) / (x * x - 1);
            EXPECT_LT(std::abs(p / slope / 2), 2.3e-16L * node[q]) << n << " " << q;
        }
        if (n > 20) continue;  // from there on GSL's are not of a table, and worse
        gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(n);
        for (int q = 0; q < n; ++q) {
            double x, w;
            gsl_integration_glfixed_point(0, 1, q, &x, &w, table);
            EXPECT_NEAR(node[q], x, 2.3e-16) << n << " " << q;
            EXPECT_NEAR(weight[q], w, 4.5e-16 * w) << n << " " << q;
        }
        gsl_integration_glfixed_table_free(table);
    }
}

// One mode over one spring of a given height, no loss: circular arcs in two phase planes, pieced
// together by atan2. Whatever touches, and however strong the thread's damper: rho makes the
// majorant of springs.hpp small enough for the Taylor series.
TEST(Springs, GrowAtARateThatBoundsTheirSeriesWithTheThreadsDamper) {
    for (const double damping : {0.0, 1.2, 30.0, 1000.0}) {
        Scene scene = few_modes();
        String& s = scene.strings[0];
        s.thread->damping = damping;
        const Modes modes = modes_of(s, 40);
        const Oscillators osc(modes);
        const Springs springs(modes, osc, s);
        for (const auto& touching : {std::array<char, 3>{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}) {
            const double rho = springs.growth(touching.data());
            for (int a = 0; a < springs.points; ++a) {
                double sum = 0;
                for (int b = 0; b < springs.points; ++b) {
                    if (b < springs.contacts && !touching[b]) continue;
                    for (int i = 1; i < longest_series; ++i)
                        sum += std::abs(springs.h(a, b)[i]) * std::pow(rho, -i - 1) *
                               (springs.k[b] + springs.r[b] * rho);
                }
                EXPECT_LE(sum, 0.9 * (1 + 1e-12)) << damping << " point " << a << " rho " << rho;
            }
        }
    }
}

TEST(ExactContact, OneModeOnAOneSidedSpringIsArcsOfTwoSinusoids) {
    Scene scene = c3(false);
    String& s = scene.strings[0];
    s.thread.reset();
    for (double height : {0.0, 2e-5, -3e-5, 8e-5}) {
        s.barriers = {LumpedBarrier{10e-3, 2e-3, height, {4.39e5}, 1, 0}};
        const jvari::Run r = run(exact_contact, scene, settings(1));
        const Modes m = modes_of(s, 1);
        const double g = footprint_weights(m, 10e-3, 2e-3)[0], k = 4.39e5 * g * g / m.mass,
                     h = height / g;
        const double w[2] = {m.omega0[0], std::sqrt(m.omega0[0] * m.omega0[0] + k)},
                     centre[2] = {0, k * h / (w[1] * w[1])};
        double y = 1.9e-3, v = 0, t = 0, leaves = -1;
        int in = y < h ? 1 : 0, events = in;
        for (long n = 1; n < r.trace.rows; ++n) {
            const double row = n / 44100.0;
            for (;;) {  // y = centre + R cos(w tau + phi)
                const double x = y - centre[in], u = v / w[in], R = std::hypot(x, u),
                             phi = std::atan2(-u, x), c = (h - centre[in]) / R;
                // going down through h at w tau + phi = acos(c), up at 2 pi - acos(c)
                double wait = 1e9;
                if (std::abs(c) <= 1) wait = (in ? 2 * pi - std::acos(c) : std::acos(c)) - phi;
                if (wait < 1e9) wait = std::fmod(wait + 2 * pi, 2 * pi);
                leaves = t + wait / w[in];
                const double tau = std::min(leaves, row) - t, angle = w[in] * tau + phi;
                y = centre[in] + R * std::cos(angle);
                v = -R * w[in] * std::sin(angle);
                t = std::min(leaves, row);
                if (leaves > row) break;
                in = 1 - in;
                ++events;
            }
            ASSERT_NEAR(r.trace.column(1)[n], y * std::sin(0.3 * pi), 1e-13 * 1.9e-3)
                << height << " row " << n;
            ASSERT_NEAR(r.trace.column(4)[n], v * std::sin(0.3 * pi), 1e-13 * 1.9e-3 * w[1])
                << height << " row " << n;
        }
        EXPECT_EQ(fact(r, "events"), events) << height;
        EXPECT_GT(events, height < 5e-5 ? 4 : 0);  // the highest barrier never lets the string go
    }
}

TEST(ExactContact, AThreadAwayFromItsHeightIsTheDenseMatrixExponential) {
    Scene scene = few_modes();
    String& s = scene.strings[0];
    s.barriers.clear();
    s.pluck.reset();
    const int M = 7;
    const jvari::Run r = run(exact_contact, scene, settings(M));
    const Modes m = modes_of(s, M);
    const auto g = footprint_weights(m, s.thread->position, s.thread->width),
               x = displacement_weights(m, 0.3);
    // state (omega0 y, v) about the equilibrium
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * M, 2 * M), K = Eigen::MatrixXd::Zero(M, M);
    Eigen::VectorXd pull(M), z = Eigen::VectorXd::Zero(2 * M);
    for (int i = 0; i < M; ++i) {
        pull(i) = s.thread->stiffness * s.thread->height * g[i] / m.mass;
        for (int j = 0; j < M; ++j)
            K(i, j) = s.thread->stiffness * g[i] * g[j] / m.mass +
                      (i == j ? m.omega0[i] * m.omega0[i] : 0);
        for (int j = 0; j < M; ++j)
            A(M + i, M + j) =
                -s.thread->damping * g[i] * g[j] / m.mass - (i == j ? 2 * m.sigma[i] : 0);
    }
    const Eigen::VectorXd rest = K.ldlt().solve(pull);
    for (int i = 0; i < M; ++i) {
        A(i, M + i) = m.omega0[i];
        for (int j = 0; j < M; ++j) A(M + i, j) = -K(i, j) / m.omega0[j];
        z(i) = m.omega0[i] * ((i == 0 ? 1.9e-3 : 0) - rest(i));
    }
    const Eigen::EigenSolver<Eigen::MatrixXd> eigen(A);
    const Eigen::MatrixXcd X = eigen.eigenvectors();
    const Eigen::VectorXcd w0 = X.partialPivLu().solve(z.cast<std::complex<double>>());
    double last_y = 1.9e-3 * g[0], integral = 0;
    for (long n = 0; n < r.trace.rows; ++n) {
        const double t = n / 44100.0;
        Eigen::VectorXcd w = w0, sum = w0;
        for (int q = 0; q < 2 * M; ++q) {
            w(q) *= std::exp(eigen.eigenvalues()(q) * t);
            sum(q) *= (std::exp(eigen.eigenvalues()(q) * t) - 1.0) / eigen.eigenvalues()(q);
        }
        const Eigen::VectorXd now = (X * w).real(), area = (X * sum).real();
        double y = 0, yc = 0, all = 0;
        for (int i = 0; i < M; ++i) {
            y += x[i] * (now(i) / m.omega0[i] + rest(i));
            yc += g[i] * (now(i) / m.omega0[i] + rest(i));
            all += g[i] * (area(i) / m.omega0[i] + rest(i) * t);
        }
        EXPECT_NEAR(r.trace.column(1)[n], y, 1e-14) << n;
        const double force = s.thread->stiffness * (s.thread->height - (all - integral) * 44100) -
                             s.thread->damping * (yc - last_y) * 44100;
        if (n > 0) {
            EXPECT_NEAR(r.trace.column(3)[n], force, 1e-9) << n;
            EXPECT_DOUBLE_EQ(r.trace.column(5)[n], -r.trace.column(3)[n]);
        }
        last_y = yc;
        integral = all;
    }
}

// Classical Runge-Kutta on the modal equations with the kinks stepped over: an independent program,
// no series, no events.
struct BruteForce {
    Modes m;
    const String& s;
    std::vector<std::vector<double>> g;  // per barrier
    std::vector<double> thread, plucked, y, v;
    double impulse = 0;
    BruteForce(const String& string, int count)
        : m(modes_of(string, count)),
          s(string),
          y(start_of(m, string).displacement),
          v(count, 0.0) {
        for (const Barrier& b : s.barriers)
            g.push_back(footprint_weights(m, std::get<LumpedBarrier>(b).position,
                                          std::get<LumpedBarrier>(b).width));
        thread = footprint_weights(m, s.thread->position, s.thread->width);
        plucked = footprint_weights(m, s.pluck->position, s.pluck->width);
    }
    double slope(double t, const std::vector<double>& q, const std::vector<double>& u,
                 std::vector<double>& a) const {
        const auto dot = [&](const std::vector<double>& w, const std::vector<double>& z) {
            double sum = 0;
            for (int i = 0; i < m.count(); ++i) sum += w[i] * z[i];
            return sum;
        };
        const double Fc = s.thread->stiffness * (s.thread->height - dot(thread, q)) -
                          s.thread->damping * dot(thread, u),
                     Fe = force(*s.pluck, t);
        double bridge = 0;
        for (int i = 0; i < m.count(); ++i)
            a[i] = -2 * m.sigma[i] * u[i] - m.omega0[i] * m.omega0[i] * q[i] +
                   (thread[i] * Fc + plucked[i] * Fe) / m.mass;
        for (std::size_t b = 0; b < g.size(); ++b) {
            const auto& barrier = std::get<LumpedBarrier>(s.barriers[b]);
            const double F = barrier.stiffness.k * std::max(0.0, barrier.height - dot(g[b], q));
            bridge += F;
            for (int i = 0; i < m.count(); ++i) a[i] += g[b][i] * F / m.mass;
        }
        return bridge;
    }
    void step(double t, double dt) {
        const std::size_t n = y.size();
        std::vector<double> a1(n), a2(n), a3(n), a4(n), q(n), u(n), v2, v3;
        const double F1 = slope(t, y, v, a1);
        for (std::size_t i = 0; i < n; ++i)
            q[i] = y[i] + dt / 2 * v[i], u[i] = v[i] + dt / 2 * a1[i];
        const double F2 = slope(t + dt / 2, q, u, a2);
        v2 = u;
        for (std::size_t i = 0; i < n; ++i)
            q[i] = y[i] + dt / 2 * v2[i], u[i] = v[i] + dt / 2 * a2[i];
        const double F3 = slope(t + dt / 2, q, u, a3);
        v3 = u;
        for (std::size_t i = 0; i < n; ++i) q[i] = y[i] + dt * v3[i], u[i] = v[i] + dt * a3[i];
        const double F4 = slope(t + dt, q, u, a4);
        for (std::size_t i = 0; i < n; ++i) {
            y[i] += dt / 6 * (v[i] + 2 * v2[i] + 2 * v3[i] + u[i]);
            v[i] += dt / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]);
        }
        impulse += dt / 6 * (F1 + 2 * F2 + 2 * F3 + F4);
    }
};

TEST(ExactContact, TwoBarriersThreadAndPluckAreWhatABruteForceIntegratorApproaches) {
    const Scene scene = few_modes();
    const int M = 4;
    const jvari::Run r = run(exact_contact, scene, settings(M));
    EXPECT_GT(fact(r, "events"), 8);
    double previous = 1;
    for (int steps : {30, 120, 480}) {
        BruteForce brute(scene.strings[0], M);
        const auto x = displacement_weights(brute.m, 0.3);
        std::vector<double> y(r.trace.rows), bridge(r.trace.rows);
        for (long n = 0; n < r.trace.rows; ++n) {
            for (int i = 0; i < M; ++i) y[n] += x[i] * brute.y[i];
            bridge[n] = brute.impulse * 44100;
            brute.impulse = 0;
            for (int k = 0; k < steps; ++k)
                brute.step((n + static_cast<double>(k) / steps) / 44100, 1.0 / 44100 / steps);
        }
        // falls by 16: the kinks leave second order
        const double error = relative_difference(y, r.trace.column(1));
        EXPECT_LT(error, previous / 10);
        EXPECT_LT(relative_difference(bridge, r.trace.column(2)), 50 * error);
        previous = error;
    }
    EXPECT_LT(previous, 2e-7);
}

TEST(ExactContact, ABarrierNeverReachedLeavesTheClosedForm) {
    for (int laws = 0; laws < 3; ++laws) {
        Scene scene = few_modes();
        String& s = scene.strings[0];
        s.thread.reset();
        const int M = laws == 2 ? 3 : 20;
        if (laws == 0) s.damping = NoDamping{};
        // critical, overdamped, light
        if (laws == 2) s.damping = TableDamping{"", {130, 260, 390}, {2 * pi * 130, 5000, 3}};
        s.barriers = {LumpedBarrier{0.15, 2e-3, -1, {4e5}, 1, 0},
                      LumpedBarrier{0.62, 0, -2, {2e5}, 1, 0}};
        Scene free = scene;
        free.strings[0].barriers.clear();
        const jvari::Run r = run(exact_contact, scene, settings(M));
        Settings plain;
        plain.modes = M;
        const jvari::Run want = run(exact_linear, free, plain),
                         open = run(exact_contact, free, settings(M));
        EXPECT_EQ(fact(r, "events"), 0);
        for (int k : {0, 1, 4}) {
            EXPECT_LT(apart(r, want, k), 2e-13) << laws << " tap " << k;
            EXPECT_LT(apart(open, want, k), 2e-13) << laws << " tap " << k;
        }
    }
}

// Digits of a second program (long double, two dense eigen-bases, free and in contact,
// one switched to the other at events it refined itself).
TEST(ExactContact, TheC3ReleaseHasTheDigitsOfATwoBasisProgramInLongDouble) {
    const jvari::Run r = run(exact_contact, c3(), settings(133));
    EXPECT_EQ(fact(r, "events"), 563);
    EXPECT_GE(fact(r, "smallest_contact_force"), 0);
    EXPECT_LT(fact(r, "deepest_penetration"), 1e-8);
    EXPECT_LT(fact(r, "detection_tolerance"), 1e-17);
    const struct {
        int row;
        double nut, bridge;
    } digits[] = {{90, -0.021330593829415993, 0.039208094121962585},
                  {91, -0.024888435805390442, 0.043627127384851701},
                  {300, 0.16032894826303482, 0},
                  {500, -0.25498981683894734, 0.28654266405940165},
                  {882, -0.12880802225232693, 0.1772021365194909}};
    for (const auto& d : digits) {
        EXPECT_NEAR(r.trace.column(0)[d.row], d.nut, 1e-12) << d.row;
        EXPECT_NEAR(r.trace.column(2)[d.row], d.bridge, 2e-11) << d.row;
    }
    const jvari::Run usual = run(exact_contact, c3(), settings(133, "1e-10"));
    EXPECT_EQ(fact(usual, "events"), 563);
    for (int k = 0; k < 6; ++k) EXPECT_LT(apart(usual, r, k), 1e-10) << k;
}

TEST(ExactContact, AStringAtRestOnItsBarriersStaysAtRest) {
    Scene scene = c3();
    scene.strings[0].start.reset();
    scene.strings[0].barriers.push_back(LumpedBarrier{0.4, 1e-3, 0, {1e7}, 1, 0});
    scene.duration = 2e-3;
    const jvari::Run r = run(exact_contact, scene, settings(50));
    EXPECT_EQ(fact(r, "events"), 0);
    for (double x : r.trace.tap) EXPECT_EQ(x, 0);
}

TEST(ExactContact, WithoutLossesTheEnergyStaysAndWithThemTheLedgerCloses) {
    Scene pressed = c3();  // the pluck acts on what the contact does within a window
    pressed.strings[0].pluck = Pluck{-0.6, 15e-3, 12, 0.2e-3, 0.02, 0.01};
    Scene tapped = lasting(few_modes(), 0.02);  // a pluck far shorter than the fastest period
    tapped.strings[0].pluck = Pluck{-30, 1e-5, 0, 1e-3, 0.4, 0.02};
    tapped.strings[0].start = ModeShape{1, 1e-3};
    const std::vector<std::string> form{"exact_contact tolerance=1e-12"};
    const LedgerClaim::Open open{1e-13, 1e-12};
    holds(LedgerClaim("", form, {c3(false)}, {{0}, 44100, 133}, open, {.at_most = 0}, false, 20));
    holds(LedgerClaim("", form, {c3(), pressed}, {{0}, 44100, 133}, open, {.more_than = 0.05},
                      false, 20));
    holds(LedgerClaim("", form, {few_modes(), tapped}, {{0}, 44100, 12}, open, {.more_than = 0.05},
                      false, 20));
}

// A symmetric string on two equal barriers: both contacts open and close at the same instants. The
// symmetry itself is unstable (what rounding makes of it grows tenfold every 0.1 ms of contact), so
// only the first two dozen impacts are asked for.
TEST(ExactContact, EqualBarriersOnASymmetricStringShareTheirEvents) {
    Scene scene = c3(false);
    String& s = scene.strings[0];
    s.thread.reset();
    s.barriers = {LumpedBarrier{0.02, 2e-3, -1e-5, {1e7}, 1, 0},
                  LumpedBarrier{0.98, 2e-3, -1e-5, {1e7}, 1, 0}};
    scene.duration = 2.6e-3;
    scene.taps = {{"left", Quantity::displacement, 0, 0.3},
                  {"right", Quantity::displacement, 0, 0.7}};
    const jvari::Run r = run(exact_contact, scene, settings(40));
    EXPECT_EQ(r.status.outcome, Outcome::ok);
    EXPECT_GT(fact(r, "events"), 20);
    EXPECT_EQ(std::fmod(fact(r, "events"), 2), 0);
    EXPECT_LT(relative_difference(r.trace.column(0), r.trace.column(1)), 1e-13);
}

// Pressed in by 4 mm and held back by a loss of 1000 s/m, the string creeps out at 1 mm/s: 1 - beta
// v is 1e-3, and the force what is left of a thousand times as much. (Where Newton's iteration asks
// for more of it than the last bit of v gives, steps are cut without end.)
TEST(ExactContact, AContactThatCreepsUnderAStrongLossTakesAFewStepsAWindow) {
    Scene scene = c3();
    String& s = scene.strings[0];
    s.tension = 1000;
    s.barriers = {LumpedBarrier{0.6, 0, 0, {2e7}, 1, 1000}};
    s.thread.reset();
    s.start = TriangleShape{0.9, -7e-3, 0};
    scene.duration = 5e-4;
    scene.taps.erase(scene.taps.begin() + 3);  // of the thread
    const jvari::Run r = run(exact_contact, scene, settings(5, "1e-10"));
    Settings stiff;
    stiff.modes = 5;
    stiff.options = {{"method", "bdf"}, {"rtol", "1e-12"}};
    const jvari::Run other = run(sundials, scene, stiff);
    ASSERT_EQ(r.status.outcome, Outcome::ok);
    ASSERT_EQ(other.status.outcome, Outcome::ok);
    EXPECT_LT(fact(r, "contact_steps"), 10 * fact(r, "windows"));
    EXPECT_EQ(fact(r, "events"), 1);
    for (int k = 0; k < r.trace.taps(); ++k)
        EXPECT_LT(apart(r, other, k), 1e-7) << r.trace.names[k];
}

// 1e5 N/m is soft against a window, 1e10 stiff: contact is split there.
TEST(ExactContact, EveryStiffnessIsWhatAStiffIntegratorMakesOfIt) {
    for (const double k : {1e4, 1e6, 1e8, 1e10}) {
        Scene scene = c3();
        scene.duration = 2e-3;
        std::get<LumpedBarrier>(scene.strings[0].barriers[0]).stiffness.k = k;
        const jvari::Run r = run(exact_contact, scene, settings(80)),
                         want = run(sundials, scene, {0, 44100, 80, {}});
        for (int tap = 0; tap < 5; ++tap)
            EXPECT_LT(apart(r, want, tap), 1e-8) << k << " tap " << tap;
    }
}

// Of ten random strings the one whose contact force suffers most: what a window cuts off shows
// twelvefold in it.
TEST(ExactContact, ToleranceIsWhatTheTapsHoldForcesIncluded) {
    Scene scene = c3();
    String& s = scene.strings[0];
    auto& b = std::get<LumpedBarrier>(s.barriers[0]);
    b.stiffness.k = 1.0548e9;
    b.position = 0.0621726;
    s.start = ModeShape{1, 1.57438e-4};
    const jvari::Run fine = run(exact_contact, scene, settings(56, "1e-13"));
    for (const auto& [tolerance, most] : {std::pair("1e-6", 1e-6), std::pair("1e-8", 1e-8)}) {
        const jvari::Run r = run(exact_contact, scene, settings(56, tolerance));
        for (int tap = 0; tap < r.trace.taps(); ++tap)
            EXPECT_LT(apart(r, fine, tap), most) << r.trace.names[tap] << " " << tolerance;
    }
}

}  // namespace
}  // namespace jvari
