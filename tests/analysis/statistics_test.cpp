#include "analysis/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace jvari {
namespace {

TEST(Statistics, MedianAndQuartilesInterpolateBetweenOrderStatistics) {
    const Spread s = spread_of(std::vector<double>{5, 1, 4, 2});
    EXPECT_EQ(s.count, 4);
    EXPECT_DOUBLE_EQ(s.median, 3);
    EXPECT_DOUBLE_EQ(s.lower, 1.75);
    EXPECT_DOUBLE_EQ(s.upper, 4.25);
}

TEST(Statistics, OneSlowRepeatDoesNotMoveTheMedian) {
    EXPECT_DOUBLE_EQ(spread_of(std::vector<double>{46, 47, 46.5, 900, 46.2}).median, 46.5);
}

TEST(Statistics, ValuesThatAreNotFiniteAreLeftOutAndCounted) {
    const double inf = std::numeric_limits<double>::infinity();
    const Spread s = spread_of(std::vector<double>{inf, 7, std::nan("")});
    EXPECT_EQ(s.count, 1);
    EXPECT_EQ(s.median, 7);
    EXPECT_EQ(s.lower, s.upper);
    EXPECT_EQ(spread_of({}).count, 0);
    EXPECT_TRUE(std::isnan(spread_of({}).median));
}

}  // namespace
}  // namespace jvari
