// Orders of data whose order is known, and a confidence interval that covers as often as it says.
#include "analysis/convergence.hpp"
#include "schemes/trace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace jvari {
namespace {
using Signal = std::vector<double>;
const Signal rates = {44100, 88200, 176400, 352800, 705600};

Signal power_law(double c, double order) {
    Signal e;
    for (double r : rates) e.push_back(c * std::pow(r, -order));
    return e;
}

TEST(Order, OfAPowerLawIsItsExponent) {
    for (double p : {0.5, 1.0, 2.0, 4.0}) {
        const Order o = observed_order(rates, power_law(3e4, p));
        EXPECT_NEAR(o.order, p, 1e-12);
        EXPECT_NEAR(o.half_width, 0, 1e-6);
        EXPECT_EQ(o.points, 5);
    }
}

TEST(Order, IntervalIsStudentsTTimesTheStandardErrorOfTheSlope) {
    // ln e = 0, -1, 1 over ln r = 0, 1, 2: slope 1/2, residuals (1/2, -1, 1/2), chi^2 = 3/2, S_xx =
    // 2, one degree of freedom: standard error sqrt(1.5/2), t(0.975; 1) = 12.7062047 (table).
    const Signal r = {1, std::exp(1.0), std::exp(2.0)}, e = {1, std::exp(-1.0), std::exp(1.0)};
    const Order o = observed_order(r, e);
    EXPECT_NEAR(o.order, -0.5, 1e-12);
    EXPECT_NEAR(o.half_width, 12.7062047 * std::sqrt(0.75), 1e-6);
}

TEST(Order, NinetyFivePercentIntervalsCoverTheTruthNinetyFiveTimesInAHundred) {
    std::mt19937 random(7);
    std::normal_distribution<double> scatter(0, 0.3);
    const int trials = 4000;
    int covered = 0;
    for (int k = 0; k < trials; ++k) {
        Signal e = power_law(1, 1);
        for (double& v : e) v *= std::exp(scatter(random));
        const Order o = observed_order(rates, e);
        covered += std::abs(o.order - 1) < o.half_width;
    }
    EXPECT_NEAR(covered / double(trials), 0.95, 0.011);  // three standard deviations of the count
}

TEST(Order, RunsThatFailedOrWereExactAreLeftOut) {
    Signal e = power_law(1, 1);
    e[0] = inf, e[2] = nan, e[4] = 0;
    Order o = observed_order(rates, e);
    EXPECT_EQ(o.points, 2);
    EXPECT_NEAR(o.order, 1, 1e-12);
    EXPECT_EQ(o.half_width, inf);
    e[1] = inf;
    o = observed_order(rates, e);
    EXPECT_EQ(o.points, 1);
    EXPECT_TRUE(std::isnan(o.order));
    EXPECT_TRUE(std::isnan(observed_order({}, {}).order));
    // the same rate twice
    EXPECT_TRUE(std::isnan(observed_order(Signal{2, 2}, Signal{1, 3}).order));
    EXPECT_THROW(observed_order(rates, Signal{1}), std::invalid_argument);
}

}  // namespace
}  // namespace jvari
