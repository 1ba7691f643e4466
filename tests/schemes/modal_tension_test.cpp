// Strings that stretch: one mode against the elliptic function, and the limit of none that does.
#include <numbers>

#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

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
        Scene scene = lasting(read_scene("steel_string_glide"), 0.25);
        scene.strings[0].damping = NoDamping{};
        scene.strings[0].start = ModeShape{1, a};
        const double exact = elliptic_frequency(scene, a);
        glide_in_cents = 1200 * std::log2(exact / modes_of(scene.strings[0], 1).omega0[0]);
        for (const char* name : {"modal_tension", "sundials"}) {
            const auto r = play(name, scene, {705600, 44100, 1, {}});
            EXPECT_NEAR(measured_frequency(r.trace.column(1)) / exact, 1, 1e-6)
                << name << " at " << a;
        }
    }
    EXPECT_GT(glide_in_cents, 40);
}

TEST(ModalTension, IsThePlainStringWhereItHardlyStretches) {
    // without contacts: the plain string has other gains
    Scene stretching = lasting(read_scene("steel_string_glide"), 0.01), plain = stretching;
    stretching.strings[0].axial_stiffness = 1e-8;
    plain.strings[0].axial_stiffness = 0;
    const Settings settings{88200, 44100, 40, {}};
    const auto a = play("modal_tension", stretching, settings),
               b = play("modal_three_point", plain, settings);
    for (int tap = 0; tap < 2; ++tap) EXPECT_LT(apart(a, b, tap), 1e-11) << tap;
}

}  // namespace
}  // namespace jvari
