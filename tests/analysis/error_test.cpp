// Waveform errors with answers known by hand, and the cases where there is nothing to divide by.
#include "analysis/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace jvari {
namespace {
using Signal = std::vector<double>;

Signal tone(long rows, double rate, double hertz, double amplitude = 1) {
    Signal x(rows);
    for (long n = 0; n < rows; ++n) x[n] = amplitude * std::cos(2 * M_PI * hertz * n / rate);
    return x;
}

Trace trace_of(std::vector<Signal> columns, std::vector<std::string> names, double rate) {
    Trace t;
    t.tap_rate = rate;
    t.names = std::move(names);
    t.rows = static_cast<long>(columns.front().size());
    t.stride = t.rows + 3;  // a run that stopped early leaves rows behind
    for (const auto& c : columns) {
        t.tap.insert(t.tap.end(), c.begin(), c.end());
        t.tap.insert(t.tap.end(), 3, 1e300);
    }
    return t;
}

TEST(Error, AScaledCopyDiffersByTheScaleInEveryWindow) {
    const Signal r = tone(4410, 44100, 131), c = tone(4410, 44100, 131, 1.03);
    for (const Window w : {Window{}, Window{0, 0.01}, Window{0.02, 0.05}})
        EXPECT_NEAR(relative_l2(c, r, 44100, w), 0.03, 1e-14);
    EXPECT_EQ(relative_l2(r, r, 44100), 0);
}

TEST(Error, AWindowHoldsItsFirstInstantAndNotItsLast) {
    const Signal r = {1, 1, 1, 1, 1}, c = {2, 1, 1, 5, 1};  // at 10 Hz: rows at 0, 0.1, ... 0.4 s
    EXPECT_DOUBLE_EQ(relative_l2(c, r, 10, {0, 0.1}), 1);
    EXPECT_EQ(relative_l2(c, r, 10, {0.1, 0.3}), 0);
    EXPECT_DOUBLE_EQ(relative_l2(c, r, 10, {0.3, 0.4}), 4);
    EXPECT_DOUBLE_EQ(relative_l2(c, r, 10, {0.25, 0.45}), 4 / std::sqrt(2.0));
    EXPECT_EQ(row_at(0.05, 44100), 2205);
    EXPECT_EQ(row_at(0.3, 10), 3);
    EXPECT_EQ(row_at(0.07, 44100), 3087);  // the product is 3087.0000000000005 in double
    EXPECT_EQ(row_at(0.3001, 10), 4);
}

TEST(Error, DoesNotDependOnTheUnit) {
    Signal r = tone(100, 1000, 37), c = tone(100, 1000, 38);
    const double e = relative_l2(c, r, 1000);
    for (double unit : {1e-200, 1e200}) {
        Signal ru = r, cu = c;
        for (double& v : ru) v *= unit;
        for (double& v : cu) v *= unit;
        EXPECT_NEAR(relative_l2(cu, ru, 1000), e, 1e-14 * e);
    }
}

TEST(Error, NothingToCompareWithIsNotANumberAndAFailedCandidateIsInfinitelyWrong) {
    const Signal zero(10, 0.0), one(10, 1.0), none;
    EXPECT_EQ(relative_l2(zero, zero, 10), 0);
    EXPECT_TRUE(std::isnan(relative_l2(one, zero, 10)));
    EXPECT_TRUE(std::isnan(relative_l2(one, none, 10)));
    EXPECT_TRUE(std::isnan(relative_l2(one, one, 10, {0.5, 0.5})));
    EXPECT_TRUE(std::isnan(relative_l2(one, one, 10, {0, 1.2})));  // beyond the reference
    EXPECT_EQ(relative_l2(one, one, 10, {0, 1.0}), 0);

    const Signal early(6, 1.0);  // rows up to 0.5 s
    EXPECT_EQ(relative_l2(early, one, 10, {0, 0.6}), 0);
    EXPECT_EQ(relative_l2(early, one, 10, {0, 0.7}), inf);
    EXPECT_EQ(relative_l2(early, one, 10), inf);
    EXPECT_EQ(relative_l2(none, one, 10), inf);
    EXPECT_EQ(relative_l2(one, early, 10), 0);  // a candidate may go on for longer

    for (double bad : {nan, inf, -inf}) {
        Signal c = one;
        c[7] = bad;
        EXPECT_EQ(relative_l2(c, one, 10), inf);
        EXPECT_EQ(relative_l2(c, one, 10, {0, 0.7}), 0);
        EXPECT_EQ(relative_l2(c, zero, 10), inf);
        EXPECT_TRUE(std::isnan(relative_l2(one, c, 10)));  // a reference with a hole is none
    }
    EXPECT_EQ(relative_l2(Signal(10, 1e300), Signal(10, 1e-300), 10), inf);  // not a NaN
}

TEST(Horizon, IsWhereTheRunningErrorOfASteadilyWorseningCopyPassesTenPercent) {
    // r = 1, c = 1 + a t: E(t)^2 = a^2 t^2/3 in the limit of many rows, so E = 0.1 at t = 0.1
    // sqrt(3)/a.
    const double rate = 1e4, a = 0.4;
    Signal r(10000, 1.0), c(10000);
    for (long n = 0; n < 10000; ++n) c[n] = 1 + a * n / rate;
    EXPECT_NEAR(horizon(c, r, rate), 0.1 * std::sqrt(3.0) / a, 2 / rate);
    EXPECT_NEAR(horizon(c, r, rate, 0.2), 0.2 * std::sqrt(3.0) / a, 2 / rate);
    EXPECT_DOUBLE_EQ(horizon(c, r, rate, 0.5), 9999 / rate);  // never
}

TEST(Horizon, AnErrorInTheFirstFaintRowsDoesNotDecide) {
    Signal r = tone(1000, 1000, 0), c;
    for (long n = 0; n < 1000; ++n) r[n] = 1 - std::exp(-0.001 * n * n);  // starts from rest
    c = r;
    c[0] = 1e-3;
    EXPECT_DOUBLE_EQ(horizon(c, r, 1000), 0.999);
    c[0] = 0.2;  // as large as it is here it is an error
    EXPECT_EQ(horizon(c, r, 1000), 0);
}

TEST(Horizon, EndsWithTheCandidate) {
    const Signal one(11, 1.0), zero(11, 0.0);
    EXPECT_DOUBLE_EQ(horizon(one, one, 10), 1.0);
    EXPECT_DOUBLE_EQ(horizon(Signal(5, 1.0), one, 10), 0.4);
    EXPECT_EQ(horizon({}, one, 10), 0);
    Signal c = one;
    c[3] = nan;
    EXPECT_DOUBLE_EQ(horizon(c, one, 10), 0.2);
    EXPECT_DOUBLE_EQ(horizon(zero, zero, 10), 1.0);
    c = zero;
    c[4] = 1e-20;  // nothing is zero but zero
    EXPECT_DOUBLE_EQ(horizon(c, zero, 10), 0.4);
    EXPECT_TRUE(std::isnan(horizon(one, {}, 10)));
    EXPECT_EQ(horizon(Signal{1.0}, Signal{1.0}, 10), 0);  // one row
}

TEST(TapErrors, AreThoseOfEachTap) {
    const Trace r = trace_of({Signal(100, 1e-3), Signal(100, 50.0)}, {"y", "nut"}, 100);
    Trace c = trace_of({Signal(100, 1.03e-3), Signal(100, 52.0)}, {"y", "nut"}, 100);
    EXPECT_NEAR(relative_l2(c, r).at(0), 0.03, 1e-14);
    EXPECT_NEAR(relative_l2(c, r).at(1), 0.04, 1e-14);
    c.tap[50] = inf;
    EXPECT_EQ(relative_l2(c, r).at(0), inf);
    EXPECT_NEAR(relative_l2(c, r, {0, 0.5}).at(0), 0.03, 1e-14);
}

TEST(TapErrors, RefuseTracesOfDifferentTaps) {
    const Trace a = trace_of({Signal(4, 1.0)}, {"nut"}, 10),
                b = trace_of({Signal(4, 1.0)}, {"bridge"}, 10);
    const Trace faster = trace_of({Signal(4, 1.0)}, {"nut"}, 20);
    EXPECT_THROW(relative_l2(a, b), std::invalid_argument);
    EXPECT_THROW(relative_l2(a, faster), std::invalid_argument);
}

}  // namespace
}  // namespace jvari
