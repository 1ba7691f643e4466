// A bar: a string that its bending stiffness alone holds.
#include <numbers>

#include "scenes/modes.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

using std::numbers::pi;

Scene bar(double hertz) {  // pi/2 sqrt(EI/mu)/L^2
    Scene scene = lasting(c3_free(), 0.02);
    String& s = scene.strings[0];
    s.tension = 0;
    s.bending_stiffness = s.linear_density * std::pow(2 * hertz * s.length * s.length / pi, 2);
    s.damping = NoDamping{};
    s.start = ModeShape{1, 1e-3};
    scene.taps = {{"y", Quantity::displacement, 0, 0.3}};
    return scene;
}

TEST(Bar, SoundsItsFirstModeInEverySchemeThatTakesIt) {
    const Scene scene = bar(130);
    int took = 0;
    for (const Descriptor* d : all_descriptors()) {
        Settings settings;
        settings.modes = 12;
        settings.sample_rate = d->clock == Clock::continuous ? 0 : 44100;
        if (!represents(*d, scene) || !refusal(d->name, scene, settings).empty()) continue;
        ++took;
        double before = 0;
        for (const int times : {1, 4}) {
            if (settings.sample_rate > 0) settings.sample_rate = times * 44100;
            settings.tap_rate = 44100;
            const auto r = play(d->name, scene, settings);
            double most = 0;
            for (long n = 0; n < r.trace.rows; ++n)
                most = std::max(
                    most, std::abs(r.trace.column(0)[n] -
                                   1e-3 * std::sin(0.3 * pi) * std::cos(260 * pi * n / 44100.0)));
            const bool grid = std::string(d->name).starts_with("finite_difference");
            EXPECT_LT(most, times == 1 ? (grid ? 5e-5 : 1e-6) : std::max(1e-8, 0.3 * before))
                << d->name;
            before = most;
        }
    }
    EXPECT_GE(took, 14);
}

TEST(Bar, MeetsAStopAsTheExactContactSays) {
    Scene scene = bar(130);
    LumpedBarrier stop;
    stop.position = 0.25 * scene.strings[0].length, stop.height = -2e-4, stop.stiffness.k = 1e5;
    scene.strings[0].barriers = {stop};
    Settings settings;
    settings.modes = 12;
    settings.tap_rate = 44100;
    const auto exact = play("exact_contact", scene, settings);
    for (const char* scheme : {"modal_two_point", "modal_three_point", "modal_two_moment"}) {
        double before = HUGE_VAL;
        for (const int times : {4, 16}) {
            settings.sample_rate = 44100 * times;
            const double error = apart(play(scheme, scene, settings), exact, 0);
            EXPECT_LT(error, 0.3 * before) << scheme;
            before = error;
        }
        EXPECT_LT(before, 1e-2) << scheme;
    }
}

}  // namespace
}  // namespace jvari
