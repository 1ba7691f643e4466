// Modes of the free string against the figures that the papers print.
#include "scenes/modes.hpp"
#include "scenes/start.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/excitation.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

String c3() { return c3_free().strings.front(); }

TEST(Modes, TheC3StringHas133ModesBelow20kHz) {
    const String s = c3();
    EXPECT_EQ(modes_below(s, 20e3), 133);
    const Modes m = modes_of(s, 133);
    EXPECT_NEAR(m.omega0.front() / (2 * std::numbers::pi), 130.89, 0.01);
    EXPECT_NEAR(
        std::sqrt(omega_squared_damped(m.omega0.back(), m.sigma.back())) / (2 * std::numbers::pi),
        19986, 1);
}

TEST(Modes, HowManyLieBelowALimitDoesNotDependOnTheLosses) {
    String s = c3();
    const int lossless = modes_below(s, 20e3);
    s.damping = PolynomialDamping{0.6, 6.5e-3, 1e-3};  // the high modes are overdamped
    EXPECT_EQ(modes_below(s, 20e3), lossless);
    EXPECT_LT(omega_squared_damped(modes_of(s, 500).omega0[499], modes_of(s, 500).sigma[499]), 0);
}

TEST(Modes, AreCountedOneByOneAsTheirFrequenciesSay) {
    const String s = c3();
    const Modes m = modes_of(s, 200);
    for (int i = 0; i < 200; ++i) {
        EXPECT_EQ(modes_below(s, m.omega0[i] / (2 * std::numbers::pi) * (1 - 1e-9)), i);
        EXPECT_EQ(modes_below(s, m.omega0[i] / (2 * std::numbers::pi) * (1 + 1e-9)), i + 1);
    }
}

TEST(Modes, TooManyOfThemAreASentenceAboutThem) {
    String s = c3();
    s.tension = 1e-9;
    s.bending_stiffness = 0;
    EXPECT_EQ(modes_below(s, 20e3), most_modes + 1);
    try {
        modes_of(c3(), most_modes + 1);
        FAIL();
    } catch (const BadScene& e) {
        EXPECT_EQ(e.key, "modes");
        EXPECT_NE(std::string(e.what()).find("1048577"), std::string::npos);
    }
}

TEST(Triangle, CoefficientsFallByTheSquareOfTheModeHoweverHigh) {  // A/n^2 sin(beta x0)
    const TriangleShape t{0.5, 1e-3, 0};
    for (const int mode : {1, 46341, 65535, 65537, 1048575}) {  // odd: sin = 1 or -1
        const double n = mode;
        EXPECT_NEAR(std::abs(coefficient(t, 1, mode)) * n * n, std::abs(coefficient(t, 1, 1)),
                    1e-9 * 1e-3)
            << mode;
    }
}

TEST(Modes, FootprintWeightIsTheIntegralOfShapeTimesFootprintAlsoAtItsLimit) {
    const String s = c3();
    const Modes m = modes_of(s, 500);
    // beta_100 w = pi: the limit pi/4 sin(beta x) of eq 20
    const double x = 0.37, w = s.length / 100;
    const auto g = footprint_weights(m, x, w);
    for (int i : {1, 99, 100, 101, 333, 500}) {
        double sum = 0;
        const int n = 4000;
        for (int k = 0; k < n; ++k) {  // midpoint rule on eq 19
            const double u = -w / 2 + (k + 0.5) * w / n;
            sum += std::numbers::pi / (2 * w) * std::cos(std::numbers::pi * u / w) *
                   std::sin(m.beta[i - 1] * (x + u)) * w / n;
        }
        EXPECT_NEAR(g[i - 1], sum, 2e-6) << i;
    }
    EXPECT_NEAR(g[99], std::numbers::pi / 4 * std::sin(m.beta[99] * x), 1e-12);
}

TEST(Modes, SmoothedTriangleStartsFromThePluckedShape) {
    String s = c3();
    s.start = TriangleShape{0.3, 1e-3, 0.0};
    const Modes m = modes_of(s, 20000);
    const auto y = start_of(m, s).displacement;
    for (double x : {0.1, 0.3, 0.65}) {
        const auto v = displacement_weights(m, x);
        double sum = 0;
        for (int i = 0; i < m.count(); ++i) sum += v[i] * y[i];
        EXPECT_NEAR(sum, 1e-3 * (x < 0.3 ? x / 0.3 : (1 - x) / 0.7), 4.9e-8)
            << x;  // the tail of the series is at most 2A/(pi^2 N x0 (1 - x0))
    }
    EXPECT_NEAR(hann_smoothing(2 * std::numbers::pi / 0.02, 0.02), 0.5, 1e-12);
    EXPECT_NEAR(hann_smoothing(2 * std::numbers::pi / 0.02 * (1 + 1e-5), 0.02), 0.5 * (1 - 1.5e-5),
                1e-9);
}

}  // namespace
}  // namespace jvari
