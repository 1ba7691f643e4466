// The stepping loop: rows, blocks, divergence, denormals.
#include "schemes/run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/c3.hpp"

namespace jvari {
namespace {

// y doubles at each step: diverges on purpose.
class Doubling final : public Scheme {
public:
    explicit Doubling(long fails_at = -1) : fails_at_(fails_at) {}
    void reset() noexcept override { n_ = 0; }
    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row, ++n_) {
            for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] = std::ldexp(1.0, static_cast<int>(2 * n_));
            if (out.energy) {
                out.energy[row] = std::ldexp(1.0, static_cast<int>(n_));
                out.energy[out.stride + row] = out.energy[2 * out.stride + row] = 0;
            }
            if (n_ == fails_at_) return {Outcome::not_converged, 2 * n_};
        }
        return {};
    }
    int dofs() const override { return 1; }

private:
    long n_ = 0, fails_at_;
};

Scene second() {
    Scene s = c3_free();
    s.duration = 1;
    return s;
}

TEST(RunLoop, ATraceHasOneRowMoreThanItsDurationHasIntervals) {
    Doubling scheme;
    Scene s = second();
    s.duration = 0.06;
    const auto r = run(scheme, s, {2000, 1000, 0, {}});
    EXPECT_EQ(r.trace.rows, 61);
    EXPECT_EQ(r.steps, 122);
}

TEST(RunLoop, ARunThatOverflowsEndsWithTheRowsThatAreValid) {
    Doubling scheme;
    for (const int block : {1, 7, 64, 5000}) {
        const auto r = run(scheme, second(), {2000, 1000, 0, {}}, {.block_rows = block});
        EXPECT_EQ(r.status.outcome, Outcome::diverged);
        EXPECT_EQ(r.trace.rows, 512);  // 2^1024 is infinite
        EXPECT_EQ(r.status.step, 2 * 512);
        EXPECT_TRUE(std::isfinite(r.trace.column(0).back()));
    }
}

TEST(RunLoop, ARunThatLeavesItsEnergyBudgetHasDiverged) {
    Doubling scheme;
    const auto r = run(scheme, second(), {2000, 1000, 0, {}}, {.energy = true});
    EXPECT_EQ(r.status.outcome, Outcome::diverged);
    EXPECT_EQ(r.trace.rows, 4);  // stored 1, 2, 4, 8 and then 16 > 10 x 1
}

TEST(RunLoop, ARunThatFailsKeepsTheRowsUpToTheFailingStep) {
    for (const int block : {1, 7, 64}) {
        Doubling scheme(100);
        const auto r = run(scheme, second(), {2000, 1000, 0, {}}, {.block_rows = block});
        EXPECT_EQ(r.status.outcome, Outcome::not_converged);
        EXPECT_EQ(r.trace.rows, 101);
    }
}

TEST(RunLoop, DenormalsAreFlushedForItsLifeOnly) {
    volatile double tiny = std::numeric_limits<double>::min(), half = 0.5;
    EXPECT_NE(tiny * half, 0);
    {
        const FlushDenormals flush;
        EXPECT_EQ(tiny * half, 0);
    }
    EXPECT_NE(tiny * half, 0);
}

}  // namespace
}  // namespace jvari
