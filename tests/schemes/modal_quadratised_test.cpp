// Quadratised contact: its own energy is balanced to rounding in every variant, which proves
// nothing; the released variant pushes only and converges to the discrete-gradient contact, the raw
// one does neither.
#include "schemes/contact/quadratised_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "scenes/modes.hpp"
#include "schemes/modal/modal_string.hpp"
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
// A scheme and its options: "modal_quadratised levels=3 variant=raw".
const char *const two = "modal_quadratised", *const three = "modal_quadratised levels=3",
                  *const raw_two = "modal_quadratised variant=raw",
                  *const raw_three = "modal_quadratised levels=3 variant=raw",
                  *const all[] = {two, three, raw_two, raw_three};
Run play(const std::string& form, const Scene& scene, Settings settings,
         const RunOptions& options = {}) {
    std::istringstream words(form);
    std::string name, option;
    words >> name;
    while (words >> option)
        settings.options.emplace_back(option.substr(0, option.find('=')),
                                      option.substr(option.find('=') + 1));
    return run(scheme(name), scene, settings, options);
}
Run play(const std::string& name, Scene scene, double seconds, int times, bool energy = false,
         int modes = 133) {
    scene.duration = seconds;
    RunOptions options;
    options.energy = energy;
    return play(name, scene, {44100.0 * times, 44100, modes, {}}, options);
}
double fact(const Run& r, const std::string& name) {
    for (const Fact& f : r.facts)
        if (f.name == name) return f.value;
    throw std::runtime_error("no fact " + name);
}
double distance(std::span<const double> a, std::span<const double> b) {  // relative L2
    double difference = 0, size = 0;
    for (std::size_t n = 0; n < b.size(); ++n) {
        difference += (a[n] - b[n]) * (a[n] - b[n]);
        size += b[n] * b[n];
    }
    return std::sqrt(difference / size);
}
// of the ledger per row, relative to the largest stored energy so far
double worst_residual(const Trace& t) {
    const auto stored = t.energy_column(0), supplied = t.energy_column(1),
               dissipated = t.energy_column(2);
    double worst = 0, largest = std::abs(stored[0]);
    for (long n = 1; n < t.rows; ++n) {
        largest = std::max(largest, std::abs(stored[n]));
        worst = std::max(
            worst, std::abs(stored[n] - stored[n - 1] - supplied[n] + dissipated[n]) / largest);
    }
    return worst;
}
Scene with_exponent(Scene scene, double exponent) {
    std::get<LumpedBarrier>(scene.strings.front().barriers.front()).exponent = exponent;
    return scene;
}

TEST(Quadratised, OwnEnergyIsBalancedToRoundingWithAndWithoutLosses) {
    const Scene scenes[] = {c3_release(), lossless(c3_release()), c3_pluck(), lossless(c3_pluck()),
                            with_exponent(c3_pluck(), 1.5)};
    for (const char* name : all)
        for (const Scene& scene : scenes)
            for (int times : {1, 3}) {
                const auto r = play(name, scene, 0.04, times, true, 60);
                EXPECT_EQ(r.status.outcome, Outcome::ok);
                EXPECT_LT(worst_residual(r.trace), 1e-13) << name << " x" << times;
                for (double d : r.trace.energy_column(2)) ASSERT_GE(d, 0) << name;
            }
}

TEST(Quadratised, LosslessReleaseKeepsItsFirstEnergy) {
    for (const char* name : all) {
        const auto r = play(name, lossless(c3_release()), 0.1, 1, true);
        const auto stored = r.trace.energy_column(0);
        EXPECT_NEAR(stored.back() / stored.front(), 1, 1e-11) << name;
    }
}

// sum m omega0^2 y^2/2 and the thread's spring
TEST(Quadratised, WithoutAPluckTheStoredEnergyStartsAsThatOfTheShape) {
    const Scene scene = lossless(c3_release());
    const Modes modes = modes_of(scene.strings.front(), 1);
    const double y = 1.9e-3, y_c = footprint_weights(modes, 5e-3, 1.2e-3)[0] * y;
    const double true_energy =
        0.5 * modes.mass * modes.omega0[0] * modes.omega0[0] * y * y + 0.5 * 1.2e5 * y_c * y_c;
    const auto off = [&](const char* name, int times) {
        return std::abs(
            play(name, scene, 1e-4, times, true).trace.energy_column(0)[0] / true_energy - 1);
    };
    EXPECT_LT(off(two, 1), 1e-3);  // the adapted elasticity of eq 37 differs by (omega dt)^2/12
    EXPECT_LT(off(two, 64), 1e-7);
    EXPECT_LT(off(three, 256), 2e-5);  // that of the first half step, second order in time
    EXPECT_GT(off(three, 64) / off(three, 256), 14);
}

TEST(Quadratised, FreeMotionIsExact) {
    Scene scene = c3_free();
    scene.strings.front().initial = TriangleInitial{0.2, 2e-3, 0.02};
    scene.taps = {{"y", Quantity::displacement, 0, 0.3}, {"v", Quantity::velocity, 0, 0.3}};
    const Scene quiet = lossless(scene);
    const auto closed = [](const Scene& s, double t) {
        const Modes m = modes_of(s.strings.front(), 100);
        const auto y0 = initial_displacement(m, s.strings.front()),
                   w = displacement_weights(m, 0.3);
        double y = 0;
        for (int i = 0; i < 100; ++i) {
            const double omega = std::sqrt(omega_squared_damped(m.omega0[i], m.sigma[i]));
            y += w[i] * y0[i] * std::exp(-m.sigma[i] * t) *
                 (std::cos(omega * t) + m.sigma[i] / omega * std::sin(omega * t));
        }
        return y;
    };
    const std::pair<const char*, const Scene*> cases[] = {
        {two, &quiet}, {three, &quiet}, {three, &scene}};
    for (const auto& [name, s] : cases) {
        const auto r = play(name, *s, 0.5, 1, false, 100);
        double worst = 0;
        for (long n = 0; n < r.trace.rows; n += 7)
            worst = std::max(worst, std::abs(r.trace.column(0)[n] - closed(*s, n / 44100.0)));
        EXPECT_LT(worst, 1e-10 * 2e-3) << name;
        EXPECT_EQ(r.dofs, 200);
    }
    // velocity: second-order, low modes
    const auto coarse = play(three, scene, 0.01, 16, false, 5);
    const auto y = coarse.trace.column(0), v = coarse.trace.column(1);
    EXPECT_EQ(v[0], 0);
    for (long n = 1; n + 1 < coarse.trace.rows; ++n)
        EXPECT_NEAR(v[n], (y[n + 1] - y[n - 1]) * 22050, 0.02 * 2);
}

TEST(Quadratised, AnOverdampedModeFollowsItsClosedForm) {
    Scene scene = c3_free();
    scene.strings.front().damping = PolynomialDamping{1500, 0, 0};  // omega0 of mode 1 is 822/s
    scene.strings.front().initial = ModeInitial{1, 1e-3};
    const Modes m = modes_of(scene.strings.front(), 1);
    const double g = std::sqrt(-omega_squared_damped(m.omega0[0], m.sigma[0])),
                 w = displacement_weights(m, 0.3)[0];
    const auto r = play(three, scene, 0.01, 1, false, 1);
    for (long n = 0; n < r.trace.rows; ++n) {
        const double t = n / 44100.0;
        EXPECT_NEAR(
            r.trace.column(1)[n],
            w * 1e-3 * std::exp(-1500 * t) * (std::cosh(g * t) + 1500 / g * std::sinh(g * t)),
            1e-15);
    }
}

TEST(Quadratised, ReleasedConvergesToTheDiscreteGradientAndRawDoesNot) {
    // another contact solver, another code
    const auto truth = play("modal_two_point", c3_release(), 0.01, 256);
    const auto error = [&](const std::string& name, int times) {
        return distance(play(name, c3_release(), 0.01, times).trace.column(0),
                        truth.trace.column(0));
    };
    for (const char* name : {two, three}) {
        double last = 1;
        for (int times : {1, 4, 16, 64}) {
            const double e = error(name, times);
            EXPECT_LT(e, 0.4 * last) << name << " x" << times;
            last = e;
        }
        EXPECT_LT(last, 2e-4) << name;
    }
    for (const char* name : {raw_two, raw_three}) EXPECT_GT(error(name, 64), 0.03) << name;
}

TEST(Quadratised, ReleasedNeverPullsNorKeepsPsiOutOfContactAndRawIsFlagged) {
    for (const char* name : {two, three})
        for (const Scene& scene : {c3_release(), c3_pluck(), with_exponent(c3_pluck(), 2.3)}) {
            const auto r = play(name, scene, 0.03, 4);
            EXPECT_EQ(fact(r, "smallest_contact_force"), 0) << name;
            EXPECT_EQ(fact(r, "psi_out_of_contact"), 0) << name;
            EXPECT_GT(fact(r, "deepest_penetration"), 0) << name;
            for (double f : r.trace.column(2)) ASSERT_GE(f, 0) << name;
        }
    for (const char* name : {raw_two, raw_three}) {
        const auto r = play(name, c3_release(), 0.02, 64);
        EXPECT_LT(fact(r, "smallest_contact_force"), -0.1) << name;  // N: adhesion
        EXPECT_GT(fact(r, "psi_gap"), 0.5) << name;
        EXPECT_GT(fact(r, "psi_out_of_contact"), 0.1) << name;
    }
}

// a soft bed that the string lies in: psi = sqrt(K) eta is linear
TEST(Quadratised, LastingLinearContactKeepsPsiAndRefinesToTheTruth) {
    Scene scene = lossless(c3_release());
    auto& b = std::get<LumpedBarrier>(scene.strings.front().barriers.front());
    b.stiffness.k = 50;
    b.height = 1e-2;
    b.position = 0.2;
    for (const char* name : {two, raw_two}) {
        const auto r = play(name, scene, 1e-3, 1, true, 30);
        EXPECT_LT(fact(r, "psi_gap"), 1e-12) << name;
        EXPECT_LT(fact(r, "energy_gap"), 1e-12 * r.trace.energy_column(0)[0]) << name;
        EXPECT_LT(distance(r.trace.column(0),
                           play("modal_two_point", scene, 1e-3, 1, false, 30).trace.column(0)),
                  1e-11)
            << name;
    }
    // Three-point, started inside the barrier: second order, so the first step is right as well.
    const auto fine = play("modal_two_point", scene, 1e-3, 256, false, 30);
    const double e4 =
        distance(play(three, scene, 1e-3, 4, false, 30).trace.column(1), fine.trace.column(1));
    const double e16 =
        distance(play(three, scene, 1e-3, 16, false, 30).trace.column(1), fine.trace.column(1));
    EXPECT_GT(e4 / e16, 12);
    EXPECT_LT(e16, 1e-3);
}

TEST(Quadratised, SoftPowerContactsOfBothFormsAgreeWithTheDiscreteGradient) {
    Scene scene = with_exponent(c3_release(), 1.7);
    std::get<LumpedBarrier>(scene.strings.front().barriers.front()).stiffness.k = 3e8;
    const auto truth = play("modal_two_point", scene, 0.01, 64);
    for (const char* name : {two, three})
        EXPECT_LT(distance(play(name, scene, 0.01, 64).trace.column(0), truth.trace.column(0)),
                  1e-2)
            << name;
}

// the thread acts from t = 0: without its half step the error is of first order
TEST(Quadratised, ARestBentByTheThreadStartsRight) {
    Scene scene = c3_release();
    scene.strings.front().barriers.clear();
    scene.taps.resize(2);
    const auto truth = play("modal_two_point", scene, 5e-3, 256);
    const double e4 = distance(play(three, scene, 5e-3, 4).trace.column(0), truth.trace.column(0));
    const double e16 =
        distance(play(three, scene, 5e-3, 16).trace.column(0), truth.trace.column(0));
    EXPECT_GT(e4 / e16, 10);
    EXPECT_LT(e16, 1e-3);
}

TEST(Quadratised, APluckAloneMovesTheStringAsInTheOtherSchemes) {
    Scene scene = c3_pluck();
    scene.strings.front().barriers.clear();
    scene.strings.front().pluck->duration = 2e-3;
    scene.taps = {{"y", Quantity::displacement, 0, 0.3}, {"thread", Quantity::thread_force, 0, 0}};
    const auto fine = play("modal_two_point", scene, 5e-3, 64),
               same = play("modal_two_point", scene, 5e-3, 1);
    const auto coarse = play(two, scene, 5e-3, 1), finer = play(three, scene, 5e-3, 16);
    for (int k : {0, 1}) {
        EXPECT_LT(distance(coarse.trace.column(k), same.trace.column(k)), 1e-11);
        EXPECT_LT(distance(finer.trace.column(k), fine.trace.column(k)), 1e-3);
    }
}

TEST(Quadratised, ForcesOfALongRowAreTheMeanOfItsShortRows) {
    Scene scene = c3_release();
    scene.duration = 220 / 44100.0;
    for (const char* name : all) {
        const auto shorts = play(name, scene, {176400, 176400, 60, {}}),
                   longs = play(name, scene, {176400, 44100, 60, {}});
        for (int k : {2, 3})
            for (long n = 1; n < longs.trace.rows; ++n) {
                double mean = 0, size = 0;
                for (int i = -3; i <= 0; ++i) {
                    mean += 0.25 * shorts.trace.column(k)[4 * n + i];
                    size += 0.25 * std::abs(shorts.trace.column(k)[4 * n + i]);
                }
                ASSERT_NEAR(longs.trace.column(k)[n], mean, 1e-13 * size) << name << " row " << n;
            }
    }
}

TEST(Quadratised, TheStepSolvesItsEquationsAndReleaseLeavesNothingBehind) {
    for (double alpha : {1.0, 1.5, 3.0})
        for (double c : {0.5, 1.0})
            for (double eta : {-1e-6, 1e-8, 1e-6})
                for (double psi : {1e-9, 1e-5, 1e-3})
                    for (double r0 : {-1e-5, -1e-9, 1e-9, 1e-7, 1e-5})
                        for (Quadratisation variant :
                             {Quadratisation::raw, Quadratisation::released}) {
                            const auto q = QuadratisedLaw::make({4e8, alpha}, variant, c);
                            const double theta = 1e-5;
                            const QuadratisedStep s = solve_quadratised(q, eta, psi, r0, theta);
                            const double r = r0 + theta * s.force, work = s.force * r,
                                         given = c * (psi * psi - s.psi * s.psi);
                            EXPECT_NEAR(work, given,
                                        1e-11 * (c * psi * psi + c * s.psi * s.psi +
                                                 std::abs(s.force * r0)));
                            if (variant != Quadratisation::released) continue;
                            EXPECT_GE(s.force, 0);
                            EXPECT_GE(s.psi, 0);
                            if (eta <= 0) { EXPECT_EQ(s.psi, 0); }
                        }
}

// Ducceschi et al. 2021, with eta^{n+1} - eta^{n-1} = -r
TEST(Quadratised, BothLevelsAreThePublishedFormulae) {
    const double K = 4e8, alpha = 1.5, theta = 1e-5;
    for (double eta : {-1e-6, 1e-6, 2e-5})
        for (double psi : {-2e-4, 3e-5, 1e-3})
            for (double r0 : {-1e-5, 1e-7, 1e-6}) {
                const double bare =
                    eta > 0 ? std::sqrt(K * (alpha + 1) / 2) * std::pow(eta, (alpha - 1) / 2) : 0;
                // three-point
                double F =
                    (bare * psi - 0.25 * bare * bare * r0) / (1 + 0.25 * bare * bare * theta);
                QuadratisedStep s = solve_quadratised(
                    QuadratisedLaw::make({K, alpha}, Quadratisation::raw, 1), eta, psi, r0, theta);
                EXPECT_NEAR(s.force, F, 1e-11 * std::abs(F));
                EXPECT_NEAR(s.psi, psi - 0.5 * bare * (r0 + theta * F),
                            1e-10 * std::abs(psi) + 1e-10 * std::abs(bare * r0));
                // two-point
                F = (bare * psi - 0.5 * bare * bare * r0) / (1 + 0.5 * bare * bare * theta);
                s = solve_quadratised(QuadratisedLaw::make({K, alpha}, Quadratisation::raw, 0.5),
                                      eta, psi, r0, theta);
                EXPECT_NEAR(s.force, F, 1e-11 * std::abs(F));
                EXPECT_NEAR(s.psi, psi - bare * (r0 + theta * F),
                            1e-10 * std::abs(psi) + 1e-10 * std::abs(bare * r0));
            }
}

// At 44.1 kHz all 133 modes yield by 1.045 of what they should; at eight times that the cut weighs
// more.
TEST(Quadratised, ThreeLevelsCarryMatchedComplianceWhereTheirStringIsStiffEnough) {
    const auto at = [](double rate) {
        return Settings{rate, rate, 133, {{"levels", "3"}, {"compliance", "matched"}}};
    };
    Scene scene = c3_release();
    scene.duration = 5e-3;
    try {
        make_scheme(scheme("modal_quadratised"), scene, at(44100));
        ADD_FAILURE() << "made";
    } catch (const Refusal& e) {
        EXPECT_NE(std::string(e.what()).find("yields more than the true one"), std::string::npos)
            << e.what();
    }
    const auto r = run(scheme("modal_quadratised"), scene, at(8 * 44100), {.energy = true});
    const auto stored = r.trace.energy_column(0), dissipated = r.trace.energy_column(2);
    for (long n = 1; n < r.trace.rows; ++n)
        ASSERT_NEAR(stored[n], stored[n - 1] - dissipated[n], 1e-13 * stored[0]) << n;
    EXPECT_GT(
        std::ranges::count_if(
            r.facts, [](const Fact& f) { return f.name == "series_compliance" && f.value > 0; }),
        0);
}

TEST(Quadratised, EveryFormHasOneStateBesideItsModesAndNonsenseIsRefused) {
    Scene scene = c3_release();
    scene.duration = 2e-3;
    // and psi
    for (const char* name : all) EXPECT_EQ(play(name, scene, 2e-3, 1, false, 40).dofs, 81) << name;
    EXPECT_THROW(run(scheme("modal_quadratised"), scene, {44100, 44100, 40, {{"levels", "4"}}}),
                 Refusal);
    EXPECT_THROW(
        run(scheme("modal_quadratised"), scene, {44100, 44100, 40, {{"variant", "relaxed"}}}),
        Refusal);
    // modes that would alias
    EXPECT_THROW(run(scheme("modal_quadratised"), scene, {44100, 44100, 200, {}}), Refusal);
    scene.strings.front().polarisation = Polarisation{};
    EXPECT_THROW(run(scheme("modal_quadratised"), scene, {44100, 44100, 40, {}}), Refusal);
}

}  // namespace
}  // namespace jvari
