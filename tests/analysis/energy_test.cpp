// The ledger of runs whose entries are known.
#include "analysis/energy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace jvari {
namespace {
using Signal = std::vector<double>;

struct Ledger {
    Signal stored, supplied, dissipated;
    EnergyBalance balance() const { return energy_balance(stored, supplied, dissipated); }
};
Ledger closed(int rows) {  // supplied and dissipated in eighths: every sum is exact
    Ledger l{{1}, {0}, {0}};
    for (int n = 1; n < rows; ++n) {
        l.supplied.push_back(0.125 * (n % 3));
        l.dissipated.push_back(0.25 * (n % 2));
        l.stored.push_back(l.stored.back() + l.supplied.back() - l.dissipated.back());
    }
    return l;
}

TEST(Energy, AClosedLedgerHasNoResidual) {
    const auto b = closed(1000).balance();
    EXPECT_EQ(b.step, 0);
    EXPECT_EQ(b.accumulated, 0);
    EXPECT_EQ(b.largest_stored, 1.125);  // up by 1/8 of two rows, down by 1/8 in three ...
    EXPECT_EQ(b.smallest_dissipated, 0);
}

TEST(Energy, OneFalseEntryShowsInItsStepAndInAllThatFollows) {
    Ledger l = closed(100);
    for (int n = 40; n < 100; ++n) l.stored[n] += 1e-6;
    for (int n = 70; n < 100; ++n) l.stored[n] -= 3e-6;
    const auto b = l.balance();
    EXPECT_EQ(b.step_row, 70);
    EXPECT_NEAR(b.step * b.largest_stored, 3e-6, 1e-15);
    EXPECT_NEAR(b.accumulated * b.largest_stored, 2e-6, 1e-15);
    l = closed(100);
    l.supplied[10] += 1e-3;
    EXPECT_NEAR(l.balance().step * l.balance().largest_stored, 1e-3, 1e-15);
    l = closed(100);
    l.dissipated[10] = -1e-3 - l.dissipated[10];  // a sign lost
    EXPECT_LT(l.balance().smallest_dissipated, 0);
    EXPECT_GT(l.balance().step, 0);
}

TEST(Energy, ALosslessDriftIsRelativeToTheLargest) {
    Ledger l{Signal(50, 2.0), Signal(50, 0.0), Signal(50, 0.0)};
    l.stored.back() = 2.0 - 2e-9;
    const auto b = l.balance();
    EXPECT_NEAR(b.drift, -1e-9, 1e-16);
    EXPECT_NEAR(b.accumulated, 1e-9, 1e-16);
    EXPECT_DOUBLE_EQ(b.smallest_stored, l.stored.back());
}

TEST(Energy, TheSumItselfAddsNothingOverAMillionRows) {
    Ledger l{{1.0}, {0.0}, {0.0}};
    long double exact = 1.0;
    for (int n = 1; n < 1000000; ++n) {
        l.supplied.push_back(1e-7 / (1 + n % 7));
        l.dissipated.push_back(0.3e-7);
        exact += static_cast<long double>(l.supplied.back()) - l.dissipated.back();
        l.stored.push_back(static_cast<double>(exact));
    }
    // half a last place of stored: 1.1e-16; sums in double drift 2e-12
    EXPECT_LT(l.balance().accumulated, 1.2e-16);
}

TEST(Energy, NothingIsHiddenWhereTheLedgerCannotBeRead) {
    const auto none = energy_balance({}, {}, {});
    EXPECT_TRUE(std::isnan(none.step) && std::isnan(none.accumulated) &&
                std::isnan(none.largest_stored));
    EXPECT_TRUE(std::isnan(energy_balance(Trace{}).step));
    const auto one = energy_balance(Signal{3.0}, Signal{0.0}, Signal{0.0});
    EXPECT_EQ(one.step, 0);
    EXPECT_EQ(one.largest_stored, 3);
    const auto zeros = energy_balance(Signal(5, 0.0), Signal(5, 0.0), Signal(5, 0.0));
    EXPECT_EQ(zeros.step, 0);
    EXPECT_EQ(zeros.drift, 0);
    // supplied and lost without trace
    EXPECT_EQ(energy_balance(Signal(5, 0.0), Signal(5, 1.0), Signal(5, 0.0)).step, inf);
    for (double bad : {nan, inf}) {
        for (int column = 0; column < 3; ++column) {
            Ledger l = closed(20);
            (column == 0 ? l.stored : column == 1 ? l.supplied : l.dissipated)[9] = bad;
            EXPECT_EQ(l.balance().step, inf);
            EXPECT_EQ(l.balance().step_row, 9);
            EXPECT_EQ(l.balance().accumulated, inf);
        }
        EXPECT_EQ(energy_balance(Signal{bad}, Signal{0}, Signal{0}).step, inf);
    }
    EXPECT_THROW(energy_balance(Signal(5), Signal(5), Signal(4)), std::invalid_argument);
}

TEST(Energy, OfATraceReadsItsThreeColumns) {
    const Ledger l = closed(30);
    Trace t;
    t.rows = 30;
    t.stride = 40;
    for (const Signal* c : {&l.stored, &l.supplied, &l.dissipated}) {
        t.energy.insert(t.energy.end(), c->begin(), c->end());
        t.energy.insert(t.energy.end(), 10, nan);
    }
    EXPECT_EQ(energy_balance(t).step, 0);
    EXPECT_EQ(energy_balance(t).accumulated, 0);
}

}  // namespace
}  // namespace jvari
