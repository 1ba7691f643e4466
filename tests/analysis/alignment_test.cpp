#include "analysis/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace jvari {
namespace {

// Two partials that decay, at row `at`: the higher one has 2.6 rows a period.
double tone(double at) {
    return std::exp(-1e-4 * at) * (std::cos(0.02 * at) + 0.3 * std::cos(2.4 * at + 1));
}
std::vector<double> rows(int count, auto value) {
    std::vector<double> all;
    for (int n = 0; n < count; ++n) all.push_back(value(n));
    return all;
}
const std::vector<double> reference = rows(4000, tone);

TEST(Alignment, FindsADelayOfRowsAndOfAFractionAlsoNearHalfTheRate) {
    for (const double late : {0.25, 0.5, 3.0, -7.4, 100.0}) {
        const Alignment a =
            delayed(rows(4000, [=](int n) { return tone(n - late); }), reference, 1024);
        EXPECT_NEAR(a.late, late, 1e-2);
        EXPECT_LT(a.left, 1e-2) << late;
    }
}

TEST(Alignment, OfTwoDelaysOfAPeriodicSignalIsTheSmaller) {
    const auto periodic = [](int n) { return std::cos(0.02 * M_PI * n); };
    const Alignment a =
        delayed(rows(4000, [&](int n) { return periodic(n - 98); }), rows(4000, periodic), 1024);
    EXPECT_NEAR(a.late, -2, 1e-2);
}

TEST(Alignment, FindsAStretchAndADecayTogether) {
    for (const double stretch : {-0.08, -1e-3, 2e-4, 0.03}) {
        const Alignment a = stretched(rows(4000,
                                           [=](int n) {
                                               return std::exp(-3e-4 * n) *
                                                      tone(n * (1 + stretch)) *
                                                      std::exp(1e-4 * n * stretch);
                                           }),
                                      reference, 0);
        EXPECT_NEAR(a.stretch, stretch, 2e-5);
        EXPECT_NEAR(a.decay, 3e-4, 3e-4 * std::abs(stretch) + 1e-5);
        EXPECT_LT(a.left, 0.1) << stretch;
    }
}

TEST(Alignment, ExplainsNothingOfAnotherSignalOrOfAFewRows) {
    const auto noise = rows(4000, [](int n) { return std::cos(1e-3 * n * n); });
    EXPECT_GT(delayed(noise, reference, 1024).left, 0.8);
    EXPECT_GT(stretched(noise, reference, 0).left, 0.7);
    EXPECT_EQ(delayed(rows(20, tone), rows(20, tone), 1024).left, 1);
    EXPECT_EQ(stretched(rows(20, tone), rows(20, tone), 0).left, 1);
}

}  // namespace
}  // namespace jvari
