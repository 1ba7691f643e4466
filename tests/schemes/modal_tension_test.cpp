// Strings that stretch: one mode against the elliptic function, all modes against SUNDIALS, the
// balance of energy, with and without contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace jvari {
namespace {

const Descriptor& named(const std::string& name) {
    if (name == sundials.name) return sundials;
    return *std::find_if(schemes().begin(), schemes().end(),
                         [&](const Descriptor& d) { return d.name == name; });
}
jvari::Run ran(const std::string& name, const Scene& scene, double rate, int modes) {
    const Descriptor& d = named(name);
    jvari::Run r = run(d, scene, {d.clock == Clock::continuous ? 0 : rate, 44100, modes, {}},
                       {.energy = true});
    EXPECT_EQ(r.status.outcome, Outcome::ok) << name;
    return r;
}
double difference(std::span<const double> a, std::span<const double> b) {
    double d = 0, n = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        d += (a[i] - b[i]) * (a[i] - b[i]), n += b[i] * b[i];
    return std::sqrt(d / n);
}
Scene glide(double duration) {
    Scene scene = read_scene("steel_string_glide");
    scene.duration = duration;
    return scene;
}
Scene on_a_fret(double duration) {
    Scene scene = glide(duration);
    scene.strings[0].barriers = {LumpedBarrier{0.0364, 2e-3, -5e-4, {1e7}, 1, 0},
                                 LumpedBarrier{0.1, 2e-3, -1e-3, {1e7}, 1.3, 0}};
    scene.taps.push_back({"fret", Quantity::bridge_force, 0, 0});
    scene.taps.push_back({"v02", Quantity::velocity, 0, 0.2});
    return scene;
}
Scene of_one_mode(double amplitude) {
    Scene scene = glide(0.25);
    scene.strings[0].damping = NoDamping{};
    scene.strings[0].initial = ModeInitial{1, amplitude};
    return scene;
}

// q'' + w^2 q + g q^3 = 0 from rest at a: W = pi sqrt(w^2 + g a^2)/(2 K(k)), k^2 = g a^2/(2 (w^2 +
// g a^2)).
double elliptic_frequency(const Scene& scene, double a) {
    const String& s = scene.strings[0];
    const Modes one = modes_of(s, 1);
    const double beta = std::numbers::pi / s.length, w2 = one.omega0[0] * one.omega0[0];
    const double g = s.axial_stiffness * s.length / 8 * std::pow(beta, 4) / one.mass,
                 all = w2 + g * a * a;
    return std::numbers::pi * std::sqrt(all) /
           (2 * std::comp_ellint_1(std::sqrt(0.5 * g * a * a / all)));
}
// from crossings, each by a line through two rows
double measured_frequency(std::span<const double> y) {
    double first = -1, last = 0;
    int crossings = 0;
    for (std::size_t n = 1; n < y.size(); ++n) {
        if ((y[n - 1] > 0) == (y[n] > 0)) continue;
        last = static_cast<double>(n - 1) + y[n - 1] / (y[n - 1] - y[n]);
        if (first < 0) first = last;
        else ++crossings;
    }
    return std::numbers::pi * crossings * 44100 / (last - first);
}

TEST(ModalTension, OneModeHasTheFrequencyOfTheEllipticFunctionWhateverTheAmplitude) {
    double glide_in_cents = 0;
    for (const double a : {1e-3, 5e-3, 1e-2}) {
        const Scene scene = of_one_mode(a);
        const double exact = elliptic_frequency(scene, a);
        glide_in_cents = 1200 * std::log2(exact / modes_of(scene.strings[0], 1).omega0[0]);
        for (const std::string name : {"modal_tension", "sundials"}) {
            const jvari::Run r = ran("modal_tension", scene, 705600, 1);
            EXPECT_NEAR(measured_frequency(r.trace.column(1)) / exact, 1, 1e-6)
                << name << " at " << a;
        }
    }
    EXPECT_GT(glide_in_cents, 40);
}

TEST(ModalTension, TheErrorFallsAsTheSquareOfTheStep) {
    const Scene scene = glide(0.02);
    const jvari::Run truth = ran("sundials", scene, 0, 20);
    const double coarse = difference(ran("modal_tension", scene, 176400, 20).trace.column(1),
                                     truth.trace.column(1)),
                 fine = difference(ran("modal_tension", scene, 705600, 20).trace.column(1),
                                   truth.trace.column(1));
    EXPECT_NEAR(coarse / fine, 16, 2);
    EXPECT_LT(fine, 1e-3);
}

// The tension of mode 1 pulls a high mode: a shift of the pitch by 1/2 dT beta^2/(mu omega) at any
// rate. By a gain dt^2/m the mode at x = omega dt/2 would be pulled 2x/sin 2x times as far, and the
// error were above a tenth.
TEST(ModalTension, TheGainOfAnImpulseTunesHighModesRight) {
    Scene scene = glide(0.02);
    scene.strings[0].damping = NoDamping{};
    const jvari::Run truth = ran("sundials", scene, 0, 50);
    EXPECT_LT(
        difference(ran("modal_tension", scene, 44100, 50).trace.column(0), truth.trace.column(0)),
        0.03);
}

TEST(ModalTension, TendsToSundialsWithContactsAsWell) {
    const Scene scene = on_a_fret(0.01);
    const jvari::Run truth = ran("sundials", scene, 0, 20);
    for (const int tap : {0, 1, 2}) {
        const double coarse = difference(ran("modal_tension", scene, 352800, 20).trace.column(tap),
                                         truth.trace.column(tap)),
                     fine = difference(ran("modal_tension", scene, 2822400, 20).trace.column(tap),
                                       truth.trace.column(tap));
        EXPECT_LT(fine, 0.2 * coarse) << tap;
        EXPECT_LT(fine, tap == 2 ? 3e-2 : 1e-2) << tap;  // forces of contacts converge last
    }
}

TEST(ModalTension, KeepsItsEnergyInEveryRowWithAndWithoutContact) {
    for (const bool fretted : {false, true})
        for (const bool plucked : {false, true}) {
            Scene scene = fretted ? on_a_fret(0.02) : glide(0.02);
            if (plucked) {
                scene.strings[0].initial.reset();
                scene.strings[0].pluck = Pluck{20, 4e-3, 3, 1e-3, 0.45, 0.01};
            }
            const jvari::Run r = ran("modal_tension", scene, 88200, 40);
            const auto stored = r.trace.energy_column(0), in = r.trace.energy_column(1),
                       out = r.trace.energy_column(2);
            const double most = *std::max_element(stored.begin(), stored.begin() + r.trace.rows);
            for (long n = 1; n < r.trace.rows; ++n)
                ASSERT_NEAR(stored[n] - stored[n - 1], in[n] - out[n], 1e-11 * most)
                    << fretted << plucked << n;
        }
}

TEST(ModalTension, IsThePlainStringWhereItHardlyStretches) {
    // without contacts: the plain string has other gains
    Scene stretching = glide(0.01), plain = stretching;
    stretching.strings[0].axial_stiffness = 1e-8;
    plain.strings[0].axial_stiffness = 0;
    const jvari::Run of = ran("modal_three_point", plain, 88200, 40);
    for (int tap = 0; tap < 2; ++tap)
        EXPECT_LT(difference(ran("modal_tension", stretching, 88200, 40).trace.column(tap),
                             of.trace.column(tap)),
                  1e-11)
            << tap;
}

TEST(ModalTension, SchemesThatDoNotCarryItRefuseIt) {
    try {
        make_scheme(named("modal_two_point"), glide(0.01), {88200, 44100, 20, {}});
        ADD_FAILURE();
    } catch (const Refusal& refusal) {
        EXPECT_STREQ(refusal.what(),
                     "modal_two_point cannot represent scene steel_string_glide: it has no tension "
                     "modulation");
    }
}

}  // namespace
}  // namespace jvari
