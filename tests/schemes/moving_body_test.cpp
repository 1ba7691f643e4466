// Strings on a body that moves: energy of the whole instrument, sympathy, the limit of a body too
// heavy to move, the reference.
#include <complex>
#include <map>
#include <numbers>

#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/claims.hpp"

namespace jvari {
namespace {

constexpr double rate = 44100;
// Far more accurate than the schemes that are compared with it, and up to three times as fast as
// with its own tolerance.
constexpr const char* coarser_sundials = "sundials rtol=1e-9";

std::vector<std::string> that_move_a_body() {
    std::vector<std::string> all;
    for (const Descriptor& d : schemes())
        if (d.represents.has(Feature::moving_body)) all.emplace_back(d.name);
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
    still.start.reset();
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

Trace probed(const std::string& name, const Scene& scene, double seconds) {
    return play(name, lasting(scene, seconds), {rate, rate, 40, {}}, {.energy = true}).trace;
}

std::vector<LedgerClaim> body_claims() {
    Scene plucked = lasting(instrument(), 0.1);
    plucked.strings[0].start.reset();
    plucked.strings[0].pluck = Pluck{-0.4, 20e-3, 30.0, 0.0, 0.5, 1.0};
    plucked.strings[2].pluck = Pluck{-0.3, 10e-3, 20.0, 5e-3, 0.2, 0.1};
    Scene no_thread = lasting(lossless_instrument(), 0.05);
    for (String& s : no_thread.strings) s.thread.reset();
    no_thread.taps.clear();
    Scene losing = no_thread;
    for (String& s : losing.strings) std::get<LumpedBarrier>(s.barriers.front()).contact_loss = 50;
    const LedgerClaim::At at{{rate}, rate, 40};
    const LedgerClaim::Open open{1e-11, 1e-11};
    const auto all = that_move_a_body();
    return {
        LedgerClaim("OverASecond", all, {lasting(instrument(), 1)}, at, open),
        LedgerClaim("OverASecondWithoutLosses", all, {lasting(lossless_instrument(), 1)}, at, open,
                    {.at_most = 1e-11}),
        LedgerClaim("Plucked", all, {plucked}, at, open),
        LedgerClaim("OnContactsThatTakeNothing", all, {no_thread}, at, open, {.at_most = 1e-11}),
        LedgerClaim("OnContactsThatTakeEnergy", all, {losing}, at, open, {.more_than = 1e-3})};
}
class MovingBodyLedger : public testing::TestWithParam<LedgerClaim> {};
TEST_P(MovingBodyLedger, Closes) { holds(GetParam()); }
INSTANTIATE_TEST_SUITE_P(, MovingBodyLedger, testing::ValuesIn(body_claims()),
                         name_of<LedgerClaim>);

TEST(MovingBody, AStringThatNobodyPluckedSoundsAndIsSilentWhereTheBodyIsStill) {
    for (const std::string& name : that_move_a_body()) {
        Scene scene = instrument();
        const double moved = largest(probed(name, scene, 0.3).column(0));
        scene.body.reset();
        scene.taps.pop_back();
        const double still = largest(probed(name, scene, 0.3).column(0));
        EXPECT_GT(moved, 1e-5) << name;  // [m]
        EXPECT_EQ(still, 0) << name;
    }
}

TEST(MovingBody, OneTooHeavyToMoveChangesNothing) {
    for (const std::string& name : that_move_a_body()) {
        Scene scene = instrument();
        scene.taps.pop_back();
        // else it takes another thread force at t = 0: that of level 1, not the mean
        if (name == "modal_spatial_newton")
            for (String& s : scene.strings) s.thread.reset();
        const Trace fixed = [&] {
            Scene s = scene;
            s.body.reset();
            return probed(name, s, 0.05);
        }();
        scene.body->modes = {{1e20, 1e26, 0}};
        const Trace heavy = probed(name, scene, 0.05);
        EXPECT_LT(relative_difference(heavy.column(1), fixed.column(1)), 1e-8) << name;
        for (long n = 0; n < fixed.rows; ++n)
            EXPECT_NEAR(heavy.energy[n], fixed.energy[n], 1e-9 * fixed.energy[0]) << name;
    }
}

// Without barriers the equations are linear: two strings alike, one released, exchange their energy
// as the sum and the difference of the two go apart. The difference does not move the body.
TEST(MovingBody, TheDifferenceOfTwoStringsAlikeDoesNotMoveIt) {
    for (const std::string& name : that_move_a_body()) {
        Scene scene = instrument();
        for (String& s : scene.strings) s.barriers.clear(), s.thread.reset();
        scene.strings = {scene.strings[0], scene.strings[0]};
        std::get<ModeShape>(*scene.strings[1].start).amplitude *= -1;
        scene.taps = {{"y", Quantity::displacement, 0, 0.3}, {"support", Quantity::velocity, 0, 0}};
        const Trace t = probed(name, scene, 0.1);
        EXPECT_LT(largest(t.column(1)), 1e-12) << name;
        Scene alone_and_still = scene;
        alone_and_still.strings.pop_back();
        alone_and_still.body.reset();
        alone_and_still.taps.pop_back();
        EXPECT_LT(relative_difference(t.column(0), probed(name, alone_and_still, 0.1).column(0)),
                  1e-10)
            << name;
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
    s.start = TriangleShape{0.31, 1e-3, 0};
    // twice the string's mass; a spring to its first partial, a mass to those above 2
    const BodyMode light = resonance(200, 1e-3, 0);
    scene.body = Body{"", "", {light}};
    auto all = that_move_a_body();
    all.emplace_back(coarser_sundials);
    for (const std::string& name : all) {
        const double seconds = name == coarser_sundials ? 0.25 : 0.5;  // it is slow
        const Trace t = play(name, lasting(scene, seconds), {8 * rate, rate, 40, {}}).trace;
        for (const int partial : {1, 3, 4, 5}) {
            const double f = partial_on_a_body(s, light, partial),
                         fixed = 0.5 * partial * std::sqrt(s.tension / s.linear_density) / s.length;
            EXPECT_GT(std::abs(f - fixed), 0.1) << "the body is felt";
            EXPECT_NEAR(peak_near(t.column(0), rate, f), f, 5e-3)
                << name << " partial " << partial << " of " << fixed;
        }
    }
}

double error_at(const std::string& name, const Scene& scene, int times, int modes,
                const jvari::Run& truth, int tap) {
    return apart(play(name, scene, {times * rate, rate, modes, {}}), truth, tap);
}

// Threads alone: modal schemes by the second order; a grid is the whole string's.
TEST(MovingBody, WithThreadsAloneSchemesConvergeToTheReference) {
    Scene scene = lasting(instrument(), 5e-3);
    // with losses the order of modal_spatial_newton is one
    for (String& s : scene.strings) s.barriers.clear(), s.damping = NoDamping{};
    for (BodyMode& m : scene.body->modes) m.damping = 0;
    std::vector<std::string> modal, grids;
    for (const std::string& name : that_move_a_body())
        (name.starts_with("finite_difference") ? grids : modal).push_back(name);
    holds(LedgerClaim("", {"sundials"}, {scene}, {{rate}, rate, 40}, {1e-11, 1e-11}));
    holds(ConvergenceClaim("", modal, scene, {40}, {2, 8}, {coarser_sundials},
                           {.fall = 0.07, .last = 5e-4}, {0, 1, 2}));
    // the nut's force has modes beyond these
    holds(ConvergenceClaim("", grids, lasting(scene, 2.5e-3), {250}, {2, 8}, {coarser_sundials},
                           {.fall = 0.7, .last = 3e-3}, {0, 2}));
}

TEST(MovingBody, OverBridgesTheTwoPointSchemeConvergesAsThatOfOneString) {
    Scene scene = lasting(instrument(), 5e-3), one = lasting(c3_release(), 5e-3);
    one.taps = {scene.taps[1]};
    const auto truth = play("sundials", scene, {0, rate, 40, {}}, {.energy = true}),
               alone = play("exact_contact", one, {0, rate, 40, {}});
    ASSERT_EQ(truth.status.outcome, Outcome::ok);
    EXPECT_LT(ledger(truth.trace).sum, 1e-11);
    for (const int times : {1, 4, 16}) {
        const double on_body = error_at("modal_two_point", scene, times, 40, truth, 1),
                     of_one = error_at("modal_two_point", one, times, 40, alone, 0);
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
        s.start = ModeShape{1, 1.9e-3};
    }
    Scene one = drone;
    one.strings = {drone.strings[1]};
    one.body.reset();
    constexpr int modes = 10;
    const auto on_body = play("sundials", drone, {0, rate, modes, {}}),
               still = play("exact_contact", one, {0, rate, modes, {}});
    for (const char* name : {"modal_two_point", "modal_spatial_newton"}) {
        const auto order = [&](const Scene& scene, const jvari::Run& truth) {
            const double coarse = error_at(name, scene, 16, modes, truth, 0),
                         fine = error_at(name, scene, 64, modes, truth, 0);
            EXPECT_LT(fine, 1e-3) << name;
            return 0.5 * std::log2(coarse / fine);
        };
        EXPECT_NEAR(order(drone, on_body), order(one, still), 0.1) << name;
        EXPECT_GT(order(drone, on_body), 1.8) << name;
    }
}

}  // namespace
}  // namespace jvari
