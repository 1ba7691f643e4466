// What is measured beside errors: partials and compliance of the schemes, observed orders, the
// cheapest cells.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bench/check/promise.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/study/cell.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/cells_from.hpp"

namespace jvari {
namespace {

using std::numbers::pi;

const Descriptor& scheme_named(const std::string& name) {
    for (const Descriptor& d : schemes())
        if (name == d.name) return d;
    throw std::runtime_error(name);
}

std::vector<bench::check::HeardPartial> partials_of(const std::string& scheme,
                                                    const std::string& scene_name, double rate,
                                                    std::vector<std::string> set = {}) {
    const Scene scene = bench::compare::load_scene(scene_name, set, 0.15);
    return bench::check::heard_partials(scheme_named(scheme), scene, {rate, rate, 0, {}}, 0);
}
double hertz(double omega) { return omega / (2 * pi); }

// ---- Partials

TEST(Partials, TheOwnRelationOfEachSchemeIsWhatItsTraceSays) {
    for (const char* name :
         {"modal_two_point", "modal_two_point_trapezoidal", "modal_spatial_newton",
          "modal_three_point", "finite_difference_explicit", "finite_difference_theta",
          "finite_difference_hamiltonian"}) {
        const auto all =
            partials_of(name, "free_string", 88200, {"string.0.start.position=0.2137"});
        ASSERT_EQ(all.size(), 30u) << name;
        for (const auto& p : all) {
            EXPECT_NEAR(cents(p.heard.frequency, hertz(p.own.omega)), 0, 1e-5) << name << p.mode;
            EXPECT_NEAR(p.heard.decay, p.own.sigma, 1e-4) << name << p.mode;
        }
    }
}

TEST(Partials, ExactCoefficientsAreExactAndTrapezoidalOnesWarpByTheirArctangent) {
    const double dt = 1 / 44100.0;
    const Modes modes = modes_of(read_scene("free_string").strings[0], 30);
    for (const auto& p : partials_of("modal_two_point", "free_string", 44100)) {
        const double omega0 = modes.omega0[p.mode - 1], sigma = modes.sigma[p.mode - 1];
        EXPECT_NEAR(cents(p.own.omega, std::sqrt(omega0 * omega0 - sigma * sigma)), 0, 1e-9);
        EXPECT_NEAR(p.own.sigma, sigma, 1e-9);
    }
    for (const auto& p : partials_of("modal_two_point_trapezoidal", "free_string", 44100)) {
        const double omega = modes.omega0[p.mode - 1];
        EXPECT_NEAR(cents(p.own.omega, omega),
                    1200 * std::log2(2 / dt * std::atan(omega * dt / 2) / omega),
                    1e-3);  // to sigma^2/omega^2
    }
}

TEST(Partials, TheSitarOfIntegerLengthIsSharpByAsMuchAsThePaperSays) {
    const auto all = partials_of("sitar_waveguide", "sitar_c5_decay", 44100);
    ASSERT_GT(all.size(), 5u);
    // 42 samples: 525 Hz in place of 523.25
    EXPECT_NEAR(cents(hertz(all[0].own.omega), 523.25), 5.78, 0.01);
    EXPECT_NEAR(cents(all[0].heard.frequency, hertz(all[0].own.omega)), 0, 1e-6);
    EXPECT_EQ(all[1].mode, 3);  // plucked in the middle: even modes are silent
}

// ---- Static compliance at the bridge

double compliance(const std::string& scheme, double rate) {
    const Scene scene = bench::compare::load_scene("tanpura_c3_release", {}, 0.001);
    Settings settings;
    settings.sample_rate = rate;
    return fact_of(run(scheme_named(scheme), scene, settings).facts, "static_compliance");
}

// 0.926 and 1.045: an independent prototype's, C3, 133 modes, 44.1 kHz
TEST(Compliance, ExactModesDoNotMakeAnExactForcedResponse) {
    EXPECT_NEAR(compliance("modal_two_point", 44100), 0.926, 5e-4);
    EXPECT_NEAR(compliance("modal_quadratised", 44100), 0.926, 5e-4);
    EXPECT_NEAR(compliance("modal_spatial_newton", 44100), 1.045, 5e-4);
    EXPECT_NEAR(compliance("modal_explicit_penalty", 44100), 1.045, 5e-4);
    // omega0^2 dt^2/4 is the true stiffness
    EXPECT_NEAR(compliance("modal_two_point_trapezoidal", 44100), 1, 1e-12);
}

TEST(Compliance, GoesToTheTrueOneWithTheSquareOfTheStep) {
    for (const char* name : {"modal_two_point", "modal_spatial_newton"}) {
        const double coarse = compliance(name, 88200) - 1, fine = compliance(name, 176400) - 1;
        EXPECT_NEAR(coarse / fine, 4, 0.1) << name;
    }
    EXPECT_NEAR(compliance("finite_difference_explicit", 1411200), 1, 2e-3);
}

// ---- Observed orders

bench::study::Cells cells_with(const std::vector<std::vector<bench::store::Field>>& rows) {
    return test::cells_from(
        {{"scheme", "rate", "modes", "status", "error_l2_10ms_nut", "floor_error_l2_10ms_nut"},
         rows});
}

TEST(ConvergenceTable, FitsWhatServesAndSaysFromWhereToWhere) {
    const bench::store::Table t = bench::compare::convergence_table(cells_with({
        // nothing of the waveform is right
        {"a", "100", "10", "ok", "1.5", "1e-9"},
        {"a", "200", "20", "ok", "0.04", "1e-9"},  // order 2
        {"a", "400", "40", "ok", "0.01", "1e-9"},
        {"a", "800", "80", "ok", "0.0025", "1e-9"},
        // the floor
        {"a", "1600", "160", "ok", "1e-9", "1e-9"},
        {"a", "3200", "320", "diverged", "inf", "1e-9"},
        {"b", "100", "10", "ok", "0.1", "1e-9"},
        {"b", "200", "10", "ok", "0.05", "1e-9"},
    }));
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_NEAR(t.number(0, "order"), 2, 1e-9);
    EXPECT_NEAR(t.number(0, "half_width"), 0, 1e-6);
    EXPECT_EQ(t.text(0, "points"), "3");
    EXPECT_EQ(t.text(0, "from_hz"), "200");
    EXPECT_EQ(t.text(0, "to_hz"), "800");
    EXPECT_EQ(t.text(0, "modes"), "");  // a grid's change with the rate
    EXPECT_EQ(t.text(0, "window"), "10ms");
    EXPECT_EQ(t.text(0, "tap"), "nut");
    EXPECT_NEAR(t.number(1, "order"), 1, 1e-9);
    EXPECT_EQ(t.text(1, "modes"), "10");
    EXPECT_EQ(t.text(1, "half_width"), "");  // two points leave no scatter to judge by
}

TEST(ConvergenceTable, ModesThatAreSweptAreSeriesOfTheirOwn) {
    const bench::store::Table t = bench::compare::convergence_table(cells_with({
        {"a", "100", "10", "ok", "0.1", "0"},
        {"a", "200", "10", "ok", "0.05", "0"},
        {"a", "100", "20", "ok", "0.1", "0"},
        {"a", "200", "20", "ok", "0.025", "0"},
    }));
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_NEAR(t.number(0, "order"), 1, 1e-9);
    EXPECT_NEAR(t.number(1, "order"), 2, 1e-9);
}

}  // namespace
}  // namespace jvari
