// A control: the explicit penalty fails where theory says.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

const Descriptor& scheme(const std::string& name) {
    for (const Descriptor& d : schemes())
        if (name == d.name) return d;
    throw std::runtime_error("no scheme " + name);
}
double fact(const std::vector<Fact>& facts, const std::string& name) {
    for (const Fact& f : facts)
        if (f.name == name) return f.value;
    throw std::runtime_error("no fact " + name);
}
double distance(std::span<const double> a, std::span<const double> b) {
    double difference = 0, size = 0;
    for (std::size_t n = 0; n < b.size(); ++n) {
        difference += (a[n] - b[n]) * (a[n] - b[n]);
        size += b[n] * b[n];
    }
    return std::sqrt(difference / size);
}
LumpedBarrier& barrier(Scene& s) {
    return std::get<LumpedBarrier>(s.strings.front().barriers.front());
}
double limit(const Scene& scene, double rate, int modes) {
    return fact(
        make_scheme(scheme("modal_explicit_penalty"), scene, {rate, rate, modes, {}})->facts(),
        "stable_stiffness_limit");
}
const Settings probe_settings(double rate, int modes) { return {rate, 44100, modes, {}}; }

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
            s.strings.front().initial = ModeInitial{1, rest * (1 + 1e-9)};
            s.duration = 0.05;
            const auto r = run(scheme("modal_explicit_penalty"), s, probe_settings(rate, 1));
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
    s.strings.front().initial = TriangleInitial{0.3, 1e-3, 0};
    s.strings.front().barriers = {LumpedBarrier{0.3, 0, 0, {1}, 1, 0}};
    s.duration = 0.5;
    const double rate = 11025, load = 33.1 * 1e-3 / (0.3 * 0.7);
    const int count = 5;
    const Modes m = modes_of(s.strings.front(), count);
    const auto y0 = initial_displacement(m, s.strings.front()), w = displacement_weights(m, 0.3);
    double y = 0;
    for (int i = 0; i < count; ++i) y += w[i] * y0[i];
    for (double part : {0.5, 0.9, 0.99, 1.01, 1.1}) {
        const double k = part * limit(s, rate, count), rest = load / k;  // resting depth
        barrier(s).stiffness.k = k;
        barrier(s).height = y + rest;
        const auto r = run(scheme("modal_explicit_penalty"), s, {rate, rate, count, {}});
        const double depth = fact(r.facts, "deepest_penetration") / rest;
        if (part < 1) {
            EXPECT_LT(depth, 1.5) << part;
        } else {
            EXPECT_GT(depth, 2) << part;
        }
    }
}

TEST(ExplicitPenalty, C3At44100GoesOutOfRangeAndSaysAtWhichStep) {
    Scene scene = c3_release();
    scene.duration = 0.05;
    RunOptions options;
    options.energy = true;
    const auto r = run(scheme("modal_explicit_penalty"), scene, {44100, 44100, 133, {}}, options);
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
    Scene scene = lossless(c3_release());
    scene.duration = 5e-3;
    RunOptions options;
    options.energy = true;
    const auto play = [&](int times) {
        const auto r = run(scheme("modal_explicit_penalty"), scene,
                           {44100.0 * times, 44100, 133, {}}, options);
        EXPECT_GT(fact(r.facts, "stable_stiffness_limit"), 4.39e8);
        return r;
    };
    // 5.20 MHz, limit 5.19 MHz: out of its energy budget
    EXPECT_EQ(play(118).status.outcome, Outcome::diverged);
    const auto sound = play(400);
    EXPECT_EQ(sound.status.outcome, Outcome::ok);
    EXPECT_NEAR(sound.trace.energy_column(0).back() / sound.trace.energy_column(0).front(), 1,
                0.02);
}

TEST(ExplicitPenalty, ASoftContactIsPlayedRight) {
    Scene scene = c3_release();
    scene.duration = 0.01;
    barrier(scene).stiffness.k = 1e4;
    const auto truth = run(scheme("modal_two_point"), scene, {44100.0 * 64, 44100, 133, {}});
    double last = 1;
    for (int times : {8, 16, 32}) {
        const auto r =
            run(scheme("modal_explicit_penalty"), scene, {44100.0 * times, 44100, 133, {}});
        const double e = distance(r.trace.column(0), truth.trace.column(0));
        EXPECT_LT(e, 0.5 * last);
        last = e;
    }
    EXPECT_LT(last, 1e-3);
}

TEST(ExplicitPenalty, HasNoMatchedComplianceOnAnyString) {
    const auto is_refused = [](const Descriptor& d) {
        EXPECT_THROW(make_scheme(d, c3_release(), {88200, 44100, 40, {{"compliance", "matched"}}}),
                     Refusal)
            << d.name;
    };
    is_refused(scheme("modal_explicit_penalty"));
    int pairs = 0;
    for (const Descriptor& d : schemes_of_pairings())
        if (std::string(d.name).ends_with("_penalty")) is_refused(d), ++pairs;
    EXPECT_EQ(pairs, 5);
}

// ---- Several contacts

// one contact goes through other code
TEST(ExplicitPenaltyOnSeveralContacts, OneOfThemThatNothingTouchesChangesNothing) {
    for (Scene scene : {c3_release(), c3_pluck()}) {
        scene.duration = 3e-3;
        barrier(scene).stiffness.k = 1e6;
        for (const Quantity q : {Quantity::velocity, Quantity::driving_force})
            scene.taps.push_back({"more", q, 0, 0.4});
        const RunOptions options{.energy = true};
        const Settings settings{44100 * 8, 44100, 60, {}};
        const auto one = run(scheme("modal_explicit_penalty"), scene, settings, options);
        scene.strings.front().barriers.push_back(LumpedBarrier{0.6, 0, -1, {1e6}, 1, 0.5});
        const auto two = run(scheme("modal_explicit_penalty"), scene, settings, options);
        EXPECT_EQ(fact(two.facts, "contact_points"), 2);
        for (int k = 0; k < one.trace.taps(); ++k)
            EXPECT_LT(distance(two.trace.column(k), one.trace.column(k)), 1e-9) << k;
        for (int k = 0; k < 3; ++k)
            for (long n = 0; n < one.trace.rows; ++n)
                ASSERT_NEAR(two.trace.energy_column(k)[n], one.trace.energy_column(k)[n],
                            1e-9 * one.trace.energy_column(0).back())
                    << k << " row " << n;
    }
}

Scene touched_in_three_places() {  // softly, and each takes some of the energy
    Scene scene = c3_release();
    barrier(scene) = {10e-3, 2e-3, 0, {1e4}, 1.5, 20};
    scene.strings.front().barriers.push_back(LumpedBarrier{0.03, 0, 1e-5, {2e4}, 1, 5});
    scene.strings.front().barriers.push_back(LumpedBarrier{0.4, 0.02, 1e-4, {5e3}, 2, 0});
    scene.duration = 0.01;
    return scene;
}

TEST(ExplicitPenaltyOnSeveralContacts, ConvergeToTheTwoPointScheme) {
    const Scene scene = touched_in_three_places();
    const auto truth = run(scheme("modal_two_point"), scene, {44100.0 * 128, 44100, 60, {}});
    for (int tap : {0, 1, 2}) {
        double last = 1;
        for (int times : {8, 16, 32}) {
            const auto r =
                run(scheme("modal_explicit_penalty"), scene, {44100.0 * times, 44100, 60, {}});
            const double e = distance(r.trace.column(tap), truth.trace.column(tap));
            EXPECT_LT(e, 0.7 * last) << "tap " << tap << " at " << times;
            last = e;
        }
        EXPECT_LT(last, 2e-3) << "tap " << tap;
    }
}

TEST(ExplicitPenaltyOnSeveralContacts, ALossTakesEnergyAndIsAccountedFor) {
    Scene scene = lossless(touched_in_three_places());
    scene.strings.front().thread.reset();
    scene.taps.pop_back();
    const auto end = [&](double beta) {
        for (Barrier& b : scene.strings.front().barriers)
            std::get<LumpedBarrier>(b).contact_loss = beta;
        const auto r = run(scheme("modal_explicit_penalty"), scene, {44100.0 * 64, 44100, 60, {}},
                           {.energy = true});
        double lost = 0;
        for (double x : r.trace.energy_column(2)) lost += x;
        const double start = r.trace.energy_column(0)[0], left = r.trace.energy_column(0).back();
        EXPECT_NEAR((left + lost) / start, 1, 2e-3);
        return left / start;
    };
    EXPECT_NEAR(end(0), 1, 2e-3);
    EXPECT_LT(end(20), 0.95);
}

}  // namespace
}  // namespace jvari
