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
    EXPECT_EQ(s.smallest, 1);
    EXPECT_EQ(s.largest, 5);
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

TEST(Statistics, SpreadsThatOverlapAreATie) {
    const Spread slow = spread_of(std::vector<double>{10, 11, 12, 13}),
                 near = spread_of(std::vector<double>{12, 13, 14, 15});
    const Spread fast = spread_of(std::vector<double>{1, 2, 3});
    EXPECT_TRUE(tie(slow, slow));
    EXPECT_TRUE(tie(spread_of(std::vector<double>{11, 12.5, 13}), slow));
    // quartiles 10.75 ... 12.25 and 12.75 ... 14.25, although the ranges overlap
    EXPECT_FALSE(tie(slow, near));
    EXPECT_FALSE(tie(near, slow));
    EXPECT_FALSE(tie(fast, slow));
    EXPECT_TRUE(tie(fast, spread_of({})));
}

}  // namespace
}  // namespace jvari
