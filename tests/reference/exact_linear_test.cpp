// The closed form against other closed forms, and its ledger.
#include <complex>
#include <numbers>

#include "scenes/modes.hpp"
#include "tests/c3.hpp"
#include "tests/claims.hpp"

namespace jvari {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

Scene one_string(const Damping& damping) {
    Scene scene = lasting(c3_free(), 0.02);
    scene.strings[0].damping = damping;
    scene.taps = {{"y", Quantity::displacement, 0, 0.3},
                  {"v", Quantity::velocity, 0, 0.3},
                  {"nut", Quantity::nut_force, 0, 0}};
    return scene;
}

Pluck pluck(double skew) { return {-0.4, 7.3e-3, skew, 1.234e-3, 0.4, 0.01}; }

Settings linear_settings(int modes, double tap_rate = 44100) {
    Settings s;
    s.modes = modes;
    s.tap_rate = tap_rate;
    return s;
}

TEST(ExactLinear, OneModeIsTheDampedOscillatorBelowAtAndAboveCriticalDamping) {
    const double w0 = 2 * pi * 130.0, A = 1.9e-3;
    for (double ratio : {0.0, 0.01, 1 - 1e-9, 1.0, 1 + 1e-9, 3.0}) {
        const double sigma = ratio * w0;
        Scene scene = one_string(TableDamping{"", {130.0}, {sigma}});
        scene.strings[0].start = ModeShape{1, A};
        const jvari::Run r = run(exact_linear, scene, linear_settings(1));
        const double v = std::sin(0.3 * pi);
        for (long n = 0; n < r.trace.rows; n += 17) {
            const double t = n / 44100.0;
            double y = A * (1 + sigma * t) * std::exp(-sigma * t);  // critical
            // (s2 e^{s1 t} - s1 e^{s2 t})/(s2 - s1)
            if (std::abs(ratio - 1) > 1e-3) {
                const Complex root = std::sqrt(Complex(sigma * sigma - w0 * w0)),
                              s1 = -sigma + root, s2 = -sigma - root;
                y = (A * (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s2 - s1)).real();
            }
            EXPECT_NEAR(r.trace.column(0)[n], v * y,
                        (std::abs(ratio - 1) > 1e-3 ? 1e-14 : 1e-9) * A)
                << ratio << " row " << n;
        }
    }
}

TEST(ExactLinear, HasNoPhaseErrorAfterMillionsOfPeriods) {
    Scene scene = one_string(TableDamping{"", {19876.5}, {0.0}});
    scene.strings[0].start = ModeShape{1, 1.0};
    scene.duration = 100;
    const jvari::Run r = run(exact_linear, scene, linear_settings(1, 10));
    const long double w = modes_of(scene.strings[0], 1).omega0[0];
    for (long n = 0; n < r.trace.rows; ++n)
        EXPECT_NEAR(r.trace.column(0)[n],
                    std::sin(0.3 * pi) * static_cast<double>(std::cos(w * (n / 10.0L))), 1e-11)
            << n;
}

TEST(ExactLinear, AnUnskewedPluckIsThreeComplexExponentials) {
    Scene scene = one_string(PolynomialDamping{0.6, 6.5e-3, 5.0e-6});
    scene.strings[0].pluck = pluck(0);
    const Pluck& e = *scene.strings[0].pluck;
    const int count = 20;
    const jvari::Run r = run(exact_linear, scene, linear_settings(count));
    const Modes m = modes_of(scene.strings[0], count);
    const auto g = footprint_weights(m, e.position, e.width), x = displacement_weights(m, 0.3);
    const double scale = largest(r.trace.column(0));
    for (long n = 0; n < r.trace.rows; n += 7) {
        double y = 0;
        const double T = n / 44100.0 - e.start, end = std::min(T, e.duration);
        // (1/w) Im int_0^end e^{s (T - u)} F(u) du, F = a/4 (2 - e^{iqu} - e^{-iqu})
        for (int i = 0; i < count && T > 0; ++i) {
            const double w = std::sqrt(omega_squared_damped(m.omega0[i], m.sigma[i]));
            const Complex s(-m.sigma[i], w);
            Complex sum = 0;
            for (const auto& [q, part] :
                 {std::pair{0.0, 2.0}, {2 * pi / e.duration, -1.0}, {-2 * pi / e.duration, -1.0}}) {
                const Complex p = Complex(0, q) - s;
                sum += 0.25 * e.amplitude * part * std::exp(s * T) * (std::exp(p * end) - 1.0) / p;
            }
            y += x[i] * g[i] / m.mass * sum.imag() / w;
        }
        EXPECT_NEAR(r.trace.column(0)[n], y, 1e-12 * scale) << n;
    }
}

// A force F at a lifts a stiff string by y(x) = sum g_i(a) v_i(x) F/(m omega_i^2), and holds it
// still until it changes.
TEST(ExactLinear, AStringAtRestUnderASideLoadStaysUntilTheLoadChanges) {
    Scene scene = one_string(PolynomialDamping{0.6, 6.5e-3, 5.0e-6});
    scene.strings[0].start = RestStart{};
    Pluck load{};
    load.position = 0.4, load.width = 0.01, load.file = "load.csv";
    load.time = {0, 0.01, 0.012}, load.share = {1, 1, 0};
    load.amplitude = load.peak = 0.5, load.duration = 0.012;
    scene.strings[0].pluck = load;
    const int count = 40;
    const jvari::Run r = run(exact_linear, scene, linear_settings(count));
    const Modes m = modes_of(scene.strings[0], count);
    const auto g = footprint_weights(m, 0.4, 0.01), x = displacement_weights(m, 0.3);
    double y = 0;
    for (int i = 0; i < count; ++i) y += x[i] * g[i] * 0.5 / (m.mass * m.omega0[i] * m.omega0[i]);
    for (long n = 0; n <= 441; ++n) {
        EXPECT_NEAR(r.trace.column(0)[n], y, 1e-12 * y) << n;
        EXPECT_NEAR(r.trace.column(1)[n], 0, 1e-9 * y * m.omega0[0]) << n;
    }
    EXPECT_GT(std::abs(r.trace.column(1)[600]), 0.1 * y * m.omega0[0]);
}

// A riser of 1 km, kL = 141, pushed by F at a: y(x) = F/T ((L - a) x/L - sinh k(L - a) sinh kx
// / (k sinh kL)) for x <= a, with k^2 = T/EI.
TEST(ExactLinear, ARiserAtRestUnderASideLoadIsATensionedBeam) {
    Scene scene = one_string(PolynomialDamping{0.01, 0, 0});
    String& s = scene.strings[0];
    s.length = 1000, s.linear_density = 700, s.tension = 1e6, s.bending_stiffness = 5e7;
    s.start = RestStart{};
    Pluck load{};
    load.position = 300, load.file = "side.csv", load.time = {0, 1000}, load.share = {1, 1};
    load.amplitude = load.peak = 1000, load.duration = 1000;
    s.pluck = load;
    scene.duration = 2;
    scene.taps = {{"load", Quantity::displacement, 0, 300},
                  {"near", Quantity::displacement, 0, 20}};
    const jvari::Run r = run(exact_linear, scene, linear_settings(200, 10));
    const double k = std::sqrt(s.tension / s.bending_stiffness), L = s.length, a = load.position;
    for (int tap = 0; tap < 2; ++tap) {
        const double x = scene.taps[tap].position,
                     bend = std::exp(k * (x - a)) * std::expm1(-2 * k * (L - a)) *
                            std::expm1(-2 * k * x) / (-2 * k * std::expm1(-2 * k * L)),
                     y = 1000 / s.tension * ((L - a) * x / L - bend);
        for (const double row : r.trace.column(tap)) EXPECT_NEAR(row, y, 1e-4 * y) << tap;
    }
}

TEST(ExactLinear, TheTraceDoesNotDependOnHowDenselyItIsTapped) {
    for (double skew : {0.0, 30.0, -30.0, 300.0}) {
        Scene scene = one_string(PolynomialDamping{0.6, 6.5e-3, 5.0e-6});
        scene.strings[0].start = TriangleShape{0.2, 1e-4, 0.01};
        scene.strings[0].pluck = pluck(skew);
        scene.duration = 24 / 1225.0;
        const jvari::Run coarse = run(exact_linear, scene, linear_settings(60, 1225)),
                         fine = run(exact_linear, scene, linear_settings(60, 99225));
        for (int k = 0; k < 3; ++k) {
            std::vector<double> same;
            for (long n = 0; n < coarse.trace.rows; ++n)
                same.push_back(fine.trace.column(k)[81 * n]);
            EXPECT_LT(relative_difference(same, coarse.trace.column(k)), 1e-13)
                << skew << " tap " << k;
        }
    }
}

TEST(ExactLinear, TheLedgerClosesOverPluckAndDecayAlsoWithOverdampedModes) {
    std::vector<double> f, sigma;
    for (int i = 1; i <= 12; ++i) f.push_back(130.0 * i), sigma.push_back(2.5 * i * i * i);
    sigma[3] = 2 * pi * f[3];
    sigma[11] = 4 * pi * f[11];
    Scene scene = one_string(TableDamping{"", f, sigma});
    scene.strings[0].start = ModeShape{2, 1e-4};
    scene.strings[0].pluck = pluck(30);
    holds(
        LedgerClaim("", {"exact_linear"}, {scene}, {{0}, 44100, 12}, {1e-14}, {.more_than = 0.1}));
}

// A stiff string let go from a sharp corner has infinite bending energy, and the sum of its modes'
// forces at an end no limit. Row 0 is the shape's T A/(L - x0), whatever the modes. Its losses damp
// the highest at once: until the corner comes to the nut a row later is the same.
TEST(Run, TheForceOfASharpCornerIsThatOfItsShape) {
    Scene scene = c3_free();
    scene.duration = 1e-3;
    String& s = scene.strings.front();
    s.start = TriangleShape{0.3 * s.length, 1e-3, 0};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}};
    const double expected = s.tension * 1e-3 / (0.7 * s.length);
    for (const int modes : {133, 501, 2001}) {
        const auto r = run(exact_linear, scene, {0, 44100, modes, {}});
        EXPECT_DOUBLE_EQ(r.trace.column(0)[0], expected);
        if (modes > 133) { EXPECT_NEAR(r.trace.column(0)[20], expected, 1e-3 * expected); }
    }
    s.start = TriangleShape{0.3 * s.length, 1e-3, 0.1};
    const auto smooth = run(exact_linear, scene, {0, 44100, 500, {}});
    EXPECT_NE(smooth.trace.column(0)[0], expected);
    EXPECT_NEAR(smooth.trace.column(0)[0], expected, 1e-3 * expected);
}

}  // namespace
}  // namespace jvari
