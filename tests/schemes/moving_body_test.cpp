// Strings on a body that moves: energy of the whole instrument, sympathy, the limit of a body too
// heavy to move, the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

constexpr double rate = 44100;

std::vector<const Descriptor*> that_move_a_body() {
    std::vector<const Descriptor*> all;
    for (const Descriptor& d : schemes())
        if (d.represents.has(Feature::moving_body)) all.push_back(&d);
    return all;
}

BodyMode resonance(double hertz, double mass, double Q) {
    const double omega = 2 * std::numbers::pi * hertz;
    return {mass, mass * omega * omega, Q > 0 ? mass * omega / Q : 0};
}

// A string that is released over its bridge, one in unison at rest and one a fourth below it: all
// on the same two modes of a body.
Scene instrument() {
    Scene scene = c3_release();
    scene.name = "three_on_a_body";
    String still = scene.strings.front();
    still.initial.reset();
    String low = still;
    low.tension *= 0.5625;
    scene.strings = {scene.strings.front(), still, low};
    scene.taps = {{"still", Quantity::displacement, 1, 0.3},
                  {"nut", Quantity::nut_force, {}, 0},
                  {"support", Quantity::velocity, 0, 0}};
    scene.body = Body{"", "", {resonance(145, 0.05, 20), resonance(410, 0.02, 35)}};
    return scene;
}
Scene lossless_instrument() {
    Scene scene = lossless(instrument());
    for (BodyMode& m : scene.body->modes) m.damping = 0;
    return scene;
}

jvari::Run probed(const Descriptor& d, Scene scene, double seconds, double sample_rate = rate,
                  int modes = 40) {
    scene.duration = seconds;
    return run(d, scene, {sample_rate, rate, modes, {}}, {.energy = true});
}

double largest(std::span<const double> x) {
    double most = 0;
    for (const double v : x) most = std::max(most, std::abs(v));
    return most;
}
double distance(std::span<const double> a, std::span<const double> b) {  // relative, L2
    double difference = 0, size = 0;
    for (std::size_t n = 0; n < a.size(); ++n)
        difference += (a[n] - b[n]) * (a[n] - b[n]), size += b[n] * b[n];
    return std::sqrt(difference / size);
}

// What the ledger misses in all, relative to the energy of the start.
double ledger_gap(const Trace& t) {
    const double *stored = t.energy.data(), *supplied = stored + t.stride,
                 *lost = supplied + t.stride;
    double balance = 0, worst = 0, most = stored[0];
    for (long n = 1; n < t.rows; ++n) {
        balance += supplied[n] - lost[n];
        most = std::max(most, stored[n]);
        worst = std::max(worst, std::abs(stored[n] - stored[0] - balance));
    }
    return worst / most;
}

TEST(MovingBody, TheLedgerOfTheWholeInstrumentClosesOverASecond) {
    for (const Descriptor* d : that_move_a_body())
        for (const Scene& scene : {instrument(), lossless_instrument()}) {
            const jvari::Run r = probed(*d, scene, 1);
            ASSERT_EQ(r.status.outcome, Outcome::ok) << d->name;
            EXPECT_LT(ledger_gap(r.trace), 1e-11)
                << d->name << " " << (scene.body->modes[0].damping == 0 ? "lossless" : "lossy");
        }
}

TEST(MovingBody, TheLedgerClosesWhilePlucked) {
    for (const Descriptor* d : that_move_a_body()) {
        Scene scene = instrument();
        scene.strings[0].initial.reset();
        scene.strings[0].pluck = Pluck{-0.4, 20e-3, 30.0, 0.0, 0.5, 1.0};
        scene.strings[2].pluck = Pluck{-0.3, 10e-3, 20.0, 5e-3, 0.2, 0.1};
        const jvari::Run r = probed(*d, scene, 0.1);
        EXPECT_LT(ledger_gap(r.trace), 1e-11) << d->name;
    }
}

TEST(MovingBody, ContactsOnItLoseEnergy) {
    for (const Descriptor* d : that_move_a_body()) {
        Scene scene = lossless_instrument();
        for (String& s : scene.strings) s.thread.reset();
        scene.taps.clear();
        const auto lost = [&](double contact_loss) {
            for (String& s : scene.strings)
                std::get<LumpedBarrier>(s.barriers.front()).contact_loss = contact_loss;
            const jvari::Run r = probed(*d, scene, 0.05);
            EXPECT_LT(ledger_gap(r.trace), 1e-11) << d->name;
            return 1 - r.trace.energy[r.trace.rows - 1] / r.trace.energy[0];
        };
        EXPECT_LT(std::abs(lost(0)), 1e-11) << d->name;
        EXPECT_GT(lost(50), 1e-3) << d->name;
    }
}

TEST(MovingBody, AStringThatNobodyPluckedSoundsAndIsSilentWhereTheBodyIsStill) {
    for (const Descriptor* d : that_move_a_body()) {
        Scene scene = instrument();
        const double moved = largest(probed(*d, scene, 0.3).trace.column(0));
        scene.body.reset();
        scene.taps.pop_back();
        const double still = largest(probed(*d, scene, 0.3).trace.column(0));
        EXPECT_GT(moved, 1e-5) << d->name;  // [m]
        EXPECT_EQ(still, 0) << d->name;
    }
}

TEST(MovingBody, OneTooHeavyToMoveChangesNothing) {
    for (const Descriptor* d : that_move_a_body()) {
        Scene scene = instrument();
        scene.taps.pop_back();
        // else it takes another thread force at t = 0: that of level 1, not the mean
        if (std::string(d->name) == "modal_spatial_newton")
            for (String& s : scene.strings) s.thread.reset();
        const Trace fixed = [&] {
            Scene s = scene;
            s.body.reset();
            return probed(*d, s, 0.05).trace;
        }();
        scene.body->modes = {{1e20, 1e26, 0}};
        const Trace heavy = probed(*d, scene, 0.05).trace;
        EXPECT_LT(distance(heavy.column(1), fixed.column(1)), 1e-8) << d->name;
        for (long n = 0; n < fixed.rows; ++n)
            EXPECT_NEAR(heavy.energy[n], fixed.energy[n], 1e-9 * fixed.energy[0]) << d->name;
    }
}

// Without barriers the equations are linear: two strings alike, one released, exchange their energy
// as the sum and the difference of the two go apart. The difference does not move the body.
TEST(MovingBody, TheDifferenceOfTwoStringsAlikeDoesNotMoveIt) {
    for (const Descriptor* d : that_move_a_body()) {
        Scene scene = instrument();
        for (String& s : scene.strings) s.barriers.clear(), s.thread.reset();
        scene.strings = {scene.strings[0], scene.strings[0]};
        std::get<ModeInitial>(*scene.strings[1].initial).amplitude *= -1;
        scene.taps = {{"y", Quantity::displacement, 0, 0.3}, {"support", Quantity::velocity, 0, 0}};
        const Trace t = probed(*d, scene, 0.1).trace;
        EXPECT_LT(largest(t.column(1)), 1e-12) << d->name;
        Scene alone_and_still = scene;
        alone_and_still.strings.pop_back();
        alone_and_still.body.reset();
        alone_and_still.taps.pop_back();
        EXPECT_LT(distance(t.column(0), probed(*d, alone_and_still, 0.1).trace.column(0)), 1e-10)
            << d->name;
    }
}

// Of an ideal string on a spring with a mass: sin(k(L - x)), (K - M omega^2) tan(kL) = -T k, omega
// = k sqrt(T/mu).
// kL within pi/2 of pi x partial
double partial_on_a_body(const String& s, const BodyMode& m, int partial) {
    const auto off = [&](double kL) {
        const double k = kL / s.length, square = k * k * s.tension / s.linear_density;
        return (m.stiffness - m.mass * square) * std::sin(kL) + s.tension * k * std::cos(kL);
    };
    double low = std::numbers::pi * (partial - 0.5), high = std::numbers::pi * (partial + 0.5);
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (off(low) < 0) == (off(middle) < 0) ? low = middle : high = middle;
    }
    return 0.5 * low / s.length * std::sqrt(s.tension / s.linear_density) / std::numbers::pi;
}
// of the spectrum under a Hann window
double peak_near(std::span<const double> x, double sample_rate, double hertz) {
    const auto level = [&](double f) {
        const double step = 2 * std::numbers::pi / static_cast<double>(x.size() - 1);
        const std::complex<double> turn = std::polar(1.0, -2 * std::numbers::pi * f / sample_rate),
                                   turn_window = std::polar(1.0, step);
        std::complex<double> sum, at = 1, window = 1;
        for (const double v : x) {
            sum += (1 - window.real()) * v * at;
            at *= turn;
            window *= turn_window;
        }
        return std::norm(sum);
    };
    double low = hertz - 1, high = hertz + 1;
    while (high - low > 1e-4) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        level(a) < level(b) ? low = a : high = b;
    }
    return 0.5 * (low + high);
}

TEST(MovingBody, PartialsOfAStringOnASpringWithAMassAreThoseOfTheClosedForm) {
    Scene scene = lossless(c3_free());
    String& s = scene.strings.front();
    s.bending_stiffness = 0;
    s.initial = TriangleInitial{0.31, 1e-3, 0};
    // twice the string's mass; a spring to its first partial, a mass to those above 2
    const BodyMode light = resonance(200, 1e-3, 0);
    scene.body = Body{"", "", {light}};
    scene.duration = 0.5;
    std::vector<const Descriptor*> all = that_move_a_body();
    all.push_back(&sundials);
    for (const Descriptor* d : all) {
        const Trace t = run(*d, scene, {8 * rate, rate, 40, {}}).trace;
        for (const int partial : {1, 3, 4, 5}) {
            const double f = partial_on_a_body(s, light, partial),
                         fixed = 0.5 * partial * std::sqrt(s.tension / s.linear_density) / s.length;
            EXPECT_GT(std::abs(f - fixed), 0.1) << "the body is felt";
            EXPECT_NEAR(peak_near(t.column(0), rate, f), f, 5e-3)
                << d->name << " partial " << partial << " of " << fixed;
        }
    }
}

double error_at(const Descriptor& d, const Scene& scene, int times, int modes, const Trace& truth,
                int tap) {
    return distance(run(d, scene, {times * rate, rate, modes, {}}).trace.column(tap),
                    truth.column(tap));
}

TEST(MovingBody, WithThreadsAloneSchemesConvergeToTheReferenceAndModesByTheSecondOrder) {
    Scene scene = instrument();
    // with losses the order of modal_spatial_newton is one
    for (String& s : scene.strings) s.barriers.clear(), s.damping = NoDamping{};
    for (BodyMode& m : scene.body->modes) m.damping = 0;
    scene.duration = 5e-3;
    std::map<int, jvari::Run> truths;
    for (const Descriptor* d : that_move_a_body()) {
        const bool grid = std::string(d->name).starts_with("finite_difference");
        const int modes = grid ? 250 : 40;  // a grid is the whole string's
        if (!truths.contains(modes))
            truths[modes] = run(sundials, scene, {0, rate, modes, {}}, {.energy = true});
        const jvari::Run& truth = truths[modes];
        ASSERT_EQ(truth.status.outcome, Outcome::ok);
        EXPECT_LT(ledger_gap(truth.trace), 1e-11);
        for (int tap = 0; tap < 3; ++tap) {
            const double coarse = error_at(*d, scene, 2, modes, truth.trace, tap),
                         fine = error_at(*d, scene, 8, modes, truth.trace, tap);
            if (grid && tap == 1) continue;  // the nut's force has modes beyond these
            EXPECT_LT(fine, grid ? 3e-3 : 5e-4) << d->name << " tap " << tap;
            EXPECT_LT(fine, (grid ? 0.7 : 0.07) * coarse) << d->name << " tap " << tap;
        }
    }
}

TEST(MovingBody, OverBridgesTheTwoPointSchemeConvergesAsThatOfOneString) {
    Scene scene = instrument(), one = c3_release();
    scene.duration = one.duration = 5e-3;
    one.taps = {scene.taps[1]};
    const jvari::Run truth = run(sundials, scene, {0, rate, 40, {}}, {.energy = true}),
                     alone = run(exact_contact, one, {0, rate, 40, {}});
    ASSERT_EQ(truth.status.outcome, Outcome::ok);
    EXPECT_LT(ledger_gap(truth.trace), 1e-11);
    const Descriptor& d = *that_move_a_body().front();
    for (const int times : {1, 4, 16}) {
        const double on_body = error_at(d, scene, times, 40, truth.trace, 1),
                     of_one = error_at(d, one, times, 40, alone.trace, 0);
        EXPECT_LT(on_body, 1.2 * of_one) << times;
        EXPECT_GT(on_body, 0.8 * of_one) << times;
    }
}

// Few modes, so that the reference ends: all four strings strike their bridges within the 10 ms.
TEST(MovingBody, TheDroneConvergesToItsReferenceAtTheOrderOfTheSingleString) {
    Scene drone = read_scene("tanpura_drone");
    drone.duration = 0.01;
    drone.body = Body{"",
                      "",
                      {resonance(110, 0.3, 15), resonance(190, 0.15, 20), resonance(320, 0.1, 25),
                       resonance(540, 0.08, 30)}};
    drone.taps = {{"nut", Quantity::nut_force, {}, 0}};
    for (String& s : drone.strings) {
        s.pluck.reset();
        s.initial = ModeInitial{1, 1.9e-3};
    }
    Scene one = drone;
    one.strings = {drone.strings[1]};
    one.body.reset();
    constexpr int modes = 10;
    const Trace on_body = run(sundials, drone, {0, rate, modes, {}}).trace,
                still = run(exact_contact, one, {0, rate, modes, {}}).trace;
    for (const char* name : {"modal_two_point", "modal_spatial_newton"}) {
        const auto all = that_move_a_body();
        const Descriptor& d = **std::ranges::find_if(
            all, [&](const Descriptor* x) { return std::string(x->name) == name; });
        const auto order = [&](const Scene& scene, const Trace& truth) {
            const double coarse = error_at(d, scene, 16, modes, truth, 0),
                         fine = error_at(d, scene, 64, modes, truth, 0);
            EXPECT_LT(fine, 1e-3) << name;
            return 0.5 * std::log2(coarse / fine);
        };
        EXPECT_NEAR(order(drone, on_body), order(one, still), 0.1) << name;
        EXPECT_GT(order(drone, on_body), 1.8) << name;
    }
}

TEST(MovingBody, SchemesWithoutItRefuseIt) {
    for (const auto& table : {schemes(), references()})
        for (const Descriptor& d : table) {
            if (d.represents.has(Feature::moving_body)) continue;
            try {
                make_scheme(d, instrument(), {rate, rate, 40, {}});
                ADD_FAILURE() << d.name << " takes it";
            } catch (const Refusal& r) {
                EXPECT_NE(std::string(r.what()).find("moving body"), std::string::npos) << r.what();
            }
        }
}

}  // namespace
}  // namespace jvari
