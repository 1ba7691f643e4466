// A control: the explicit penalty fails where theory says.
#include "scenes/modes.hpp"
#include "scenes/start.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

const std::string penalty = "modal_explicit_penalty";

double limit(const Scene& scene, double rate, int modes) {
    return fact(make_scheme(named(penalty), scene, {rate, rate, modes, {}})->facts(),
                "stable_stiffness_limit");
}

TEST(ExplicitPenalty, TheStiffnessLimitOfC3IsReachedAt5190Kilohertz) {
    Scene scene = c3_release();
    EXPECT_NEAR(limit(scene, 5.19e6, 133) / 4.39e8, 1, 0.005);
    const Modes m = modes_of(scene.strings.front(), 133);
    double sum = 0;
    for (double g : footprint_weights(m, 10e-3, 2e-3)) sum += g * g;
    // 4m/(k^2 sum g^2): modes far below Nyquist
    EXPECT_NEAR(limit(scene, 5.19e6, 133) / (4 * m.mass * 5.19e6 * 5.19e6 / sum), 1, 1e-3);
}

TEST(ExplicitPenalty, TheBoundaryOfLastingContactIsWithinOnePercentOfTheory) {
    // one mode about its equilibrium on a bed below which it never rises
    Scene one = lossless(c3_free());
    one.strings.front().barriers = {LumpedBarrier{0.3, 0, 1e-3, {0}, 1, 0}};
    for (bool thread : {false, true}) {
        for (double part : {0.5, 0.99, 0.999, 1.001, 1.01}) {
            Scene s = one;
            if (thread) s.strings.front().thread = Thread{0.45, 0, 4e4, 0.0, 0};
            const double rate = 44100, k = part * limit(s, rate, 1);
            barrier(s).stiffness.k = k;
            const Modes m = modes_of(s.strings.front(), 1);
            const double g = displacement_weights(m, 0.3)[0], gc = displacement_weights(m, 0.45)[0];
            // The recursion's own equilibrium: num q = dt^2/m (k g (h - g q) - k_c g_c^2 q)
            const double num = 4 * std::pow(std::sin(m.omega0[0] / rate / 2), 2),
                         e = 1 / (rate * rate * m.mass);
            const double rest =
                e * k * g * 1e-3 / (num + e * k * g * g + (thread ? e * 4e4 * gc * gc : 0));
            ASSERT_GT(1e-3 - g * rest, 0);  // in contact
            s.strings.front().start = ModeShape{1, rest * (1 + 1e-9)};
            s.duration = 0.05;
            const auto r = play(penalty, s, {rate, 44100, 1, {}});
            double largest = 0;  // distance from equilibrium in units of the first
            const auto y = r.trace.column(1);
            const double w = displacement_weights(m, 0.3)[0] * rest;
            for (double v : y) largest = std::max(largest, std::abs(v - w) / (1e-9 * std::abs(w)));
            if (part < 1) {
                EXPECT_LT(largest, 2e2) << part << " thread " << thread;
            } else {
                EXPECT_GT(largest, 1e4) << part << " thread " << thread;
            }
        }
    }
}

TEST(ExplicitPenalty, AStringOfSeveralModesPressedOnAPointIsQuietBelowTheLimitAndHammersAboveIt) {
    Scene s = lossless(c3_free());
    // then a point load bends the string into the triangle
    s.strings.front().bending_stiffness = 0;
    s.strings.front().start = TriangleShape{0.3, 1e-3, 0};
    s.strings.front().barriers = {LumpedBarrier{0.3, 0, 0, {1}, 1, 0}};
    s.duration = 0.5;
    const double rate = 11025, load = 33.1 * 1e-3 / (0.3 * 0.7);
    const int count = 5;
    const Modes m = modes_of(s.strings.front(), count);
    const auto y0 = start_of(m, s.strings.front()).displacement, w = displacement_weights(m, 0.3);
    double y = 0;
    for (int i = 0; i < count; ++i) y += w[i] * y0[i];
    for (double part : {0.5, 0.9, 0.99, 1.01, 1.1}) {
        const double k = part * limit(s, rate, count), rest = load / k;  // resting depth
        barrier(s).stiffness.k = k;
        barrier(s).height = y + rest;
        const auto r = play(penalty, s, {rate, rate, count, {}});
        const double depth = fact(r, "deepest_penetration") / rest;
        if (part < 1) {
            EXPECT_LT(depth, 1.5) << part;
        } else {
            EXPECT_GT(depth, 2) << part;
        }
    }
}

TEST(ExplicitPenalty, C3At44100GoesOutOfRangeAndSaysAtWhichStep) {
    const auto r =
        play(penalty, lasting(c3_release(), 0.05), {44100, 44100, 133, {}}, {.energy = true});
    EXPECT_EQ(r.status.outcome, Outcome::diverged);
    EXPECT_GT(r.status.step, 0);
    EXPECT_LT(r.trace.rows, r.trace.stride);
    EXPECT_GT(r.trace.rows, 10);
    for (long n = 0; n < r.trace.rows; ++n)
        ASSERT_TRUE(std::isfinite(r.trace.column(0)[n]) &&
                    std::isfinite(r.trace.energy_column(0)[n]))
            << n << " of " << r.trace.rows;
}

// the limit is that of lasting contact: necessary, not sufficient
TEST(ExplicitPenalty, ImpactsGainEnergyEvenAboveTheRateOfTheLimit) {
    const auto at = [](int times) {
        const auto r = play(penalty, lasting(lossless(c3_release()), 5e-3),
                            {44100.0 * times, 44100, 133, {}}, {.energy = true});
        EXPECT_GT(fact(r, "stable_stiffness_limit"), 4.39e8);
        return r;
    };
    // 5.20 MHz, limit 5.19 MHz: out of its energy budget
    EXPECT_EQ(at(118).status.outcome, Outcome::diverged);
    const auto sound = at(400);
    EXPECT_EQ(sound.status.outcome, Outcome::ok);
    EXPECT_NEAR(sound.trace.energy_column(0).back() / sound.trace.energy_column(0).front(), 1,
                0.02);
}

// Softly touched in three places.
TEST(ExplicitPenalty, ALossTakesEnergyAndIsAccountedFor) {
    Scene scene = lasting(lossless(c3_free()), 0.01);
    scene.strings.front().start = ModeShape{1, 1.9e-3};
    scene.strings.front().barriers = {LumpedBarrier{10e-3, 2e-3, 0, {1e4}, 1.5, 0},
                                      LumpedBarrier{0.03, 0, 1e-5, {2e4}, 1, 0},
                                      LumpedBarrier{0.4, 0.02, 1e-4, {5e3}, 2, 0}};
    const auto left = [&](double beta) {
        const auto r =
            play(penalty, with_loss(scene, beta), {44100.0 * 64, 44100, 60, {}}, {.energy = true});
        const auto stored = r.trace.energy_column(0), out = r.trace.energy_column(2);
        const double lost = std::accumulate(out.begin(), out.end(), 0.0);
        EXPECT_NEAR((stored.back() + lost) / stored.front(), 1, 2e-3);
        return stored.back() / stored.front();
    };
    EXPECT_NEAR(left(0), 1, 2e-3);
    EXPECT_LT(left(20), 0.95);
}

}  // namespace
}  // namespace jvari
