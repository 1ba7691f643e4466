// The modal two-point scheme on several contact points: one point of many is the scheme of one, the
// energy ledger closes in every step, and the error against the exact solution of the same points
// falls with the rate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

const Descriptor& named(const std::string& name) {
    for (const auto& table : {schemes(), references()})
        for (const Descriptor& d : table)
            if (name == d.name) return d;
    throw std::runtime_error(name);
}

double difference(std::span<const double> a, std::span<const double> b) {
    return relative_difference(a, b);
}

double fact(const jvari::Run& r, const std::string& name) {
    for (const Fact& f : r.facts)
        if (f.name == name) return f.value;
    return std::nan("");
}

Scene with_a_barrier_out_of_reach(Scene scene) {
    scene.strings.front().barriers.push_back(LumpedBarrier{0.6, 0, -1, {1e8}, 1, 0});
    return scene;
}

Scene lasting(Scene scene, double seconds) {
    scene.duration = seconds;
    return scene;
}

TEST(SeveralPoints, OnePointThatIsInReachIsTheSchemeOfOnePoint) {
    const Scene release = lasting(c3_release(), 0.01), pluck = lasting(c3_pluck(), 0.01);
    for (const Scene& scene : {release, pluck})
        for (const double exponent : {1.0, 1.5}) {
            Scene one = scene;
            std::get<LumpedBarrier>(one.strings[0].barriers[0]).exponent = exponent;
            for (const char* name : {"modal_two_point", "modal_two_point_trapezoidal"}) {
                const Settings settings{88200, 44100, 60, {}};
                const jvari::Run a = run(named(name), one, settings, {.energy = true}),
                                 b = run(named(name), with_a_barrier_out_of_reach(one), settings,
                                         {.energy = true});
                EXPECT_EQ(fact(b, "contact_points"), 2);
                EXPECT_TRUE(std::isnan(fact(a, "contact_points")));
                for (int k = 0; k < a.trace.taps(); ++k)
                    EXPECT_LT(difference(b.trace.column(k), a.trace.column(k)), 1e-7)
                        << name << " " << k;
                EXPECT_LT(difference(b.trace.energy_column(0), a.trace.energy_column(0)), 1e-12)
                    << name;
            }
        }
}

// of one step, relative to the largest stored energy
double largest_residual(const jvari::Run& r) {
    const auto stored = r.trace.energy_column(0), supplied = r.trace.energy_column(1),
               dissipated = r.trace.energy_column(2);
    double worst = 0, most = 0;
    for (long n = 1; n < r.trace.rows; ++n)
        worst = std::max(worst, std::abs(stored[n] - stored[n - 1] - supplied[n] + dissipated[n]));
    for (const double E : stored) most = std::max(most, E);
    return worst / most;
}

Scene with_loss(Scene scene, double beta) {
    for (Barrier& b : scene.strings.front().barriers)
        std::visit([beta](auto& x) { x.contact_loss = beta; }, b);
    return scene;
}

TEST(SeveralPoints, TheEnergyLedgerClosesInEveryStep) {
    for (const char* scene : {"sitar_parabola", "two_point_bridge"})
        for (const double beta : {0.0, 5.0}) {
            const Scene s = with_loss(lasting(read_scene(scene), 0.02), beta);
            const jvari::Run r =
                run(named("modal_two_point"), s, {128e3, 128e3, 80, {}}, {.energy = true});
            ASSERT_EQ(r.status.outcome, Outcome::ok) << scene;
            EXPECT_LE(largest_residual(r), 1e-13) << scene << " " << beta;
            EXPECT_GT(fact(r, "deepest_penetration"), 0) << scene;
            double lost = 0;
            for (const double d : r.trace.energy_column(2)) {
                EXPECT_GE(d, -1e-16);
                lost += d;
            }
            EXPECT_GT(lost, 0);
        }
}

// Pressed in by 4 mm and held back by a loss of 1000 s/m a string creeps out: spring and loss
// nearly cancel, a step moves it by a thousandth of what it would move alone.
TEST(SeveralPoints, AContactThatCreepsUnderAStrongLossKeepsItsLedger) {
    Scene scene = lasting(c3_free(), 2e-3);
    String& s = scene.strings[0];
    s.tension = 1000;
    s.initial = TriangleInitial{0.9, -7e-3, 0};
    for (const bool two : {false, true}) {
        s.barriers = {LumpedBarrier{0.6, 0, 0, {2e7}, 1, 1000}};
        if (two) s.barriers.emplace_back(LumpedBarrier{0.62, 0, 0, {1e7}, 1.5, 3000});
        const jvari::Run r =
            run(named("modal_two_point"), scene, {44100, 44100, 10, {}}, {.energy = true});
        ASSERT_EQ(r.status.outcome, Outcome::ok);
        EXPECT_LE(largest_residual(r), 1e-13) << two;
    }
}

TEST(SeveralPoints, AContactThatLosesEnergyTakesEnergy) {
    const auto left = [](double beta) {
        const Scene s = lossless(with_loss(lasting(read_scene("two_point_bridge"), 0.02), beta));
        const jvari::Run r =
            run(named("modal_two_point"), s, {128e3, 128e3, 80, {}}, {.energy = true});
        return r.trace.energy_column(0)[r.trace.rows - 1] / r.trace.energy_column(0)[0];
    };
    EXPECT_NEAR(left(0), 1, 1e-11);
    EXPECT_LT(left(5), 1 - 1e-3);
}

// As many points as the reference has, and as many modes: the same problem.
void converges(const Scene& scene, int modes, const std::string& points, double most) {
    const Settings exact{0, 44100, modes, {{"nodes", points}}};
    const jvari::Run truth = run(named("sundials"), scene, exact);
    ASSERT_EQ(truth.status.outcome, Outcome::ok);
    double last = HUGE_VAL;
    for (const int rate : {4, 16, 64}) {
        const jvari::Run r = run(named("modal_two_point"), scene,
                                 {44100.0 * rate, 44100, modes, {{"points", points}}});
        ASSERT_EQ(r.status.outcome, Outcome::ok);
        const double error = difference(r.trace.column(0), truth.trace.column(0));
        EXPECT_LT(error, 0.5 * last) << scene.name << " at " << rate;
        last = error;
    }
    EXPECT_LT(last, most) << scene.name;
}

TEST(SeveralPoints, TheErrorAgainstTheSamePointsFallsWithTheRate) {
    Scene scene = lasting(read_scene("sitar_parabola"), 2e-3);
    const double L = scene.strings.front().length;
    scene.taps = {{"y", Quantity::displacement, 0, 0.1 * L}};
    // it meets the obstacle within 2 ms
    scene.strings.front().initial = TriangleInitial{0.12 * L, 1.8e-3, 0.1 * L};
    converges(scene, 30, "4", 1e-3);
    converges(with_loss(scene, 5), 30, "4", 1e-3);
}

TEST(SeveralPoints, MatchedComplianceKeepsItsLedgerAndRefusesLoss) {
    const Scene s = lasting(read_scene("sitar_parabola"), 0.01);
    const Settings matched{128e3, 128e3, 80, {{"compliance", "matched"}, {"points", "8"}}};
    const jvari::Run r = run(named("modal_two_point"), s, matched, {.energy = true});
    ASSERT_EQ(r.status.outcome, Outcome::ok);
    EXPECT_LE(largest_residual(r), 1e-12);
    EXPECT_GE(fact(r, "smallest_contact_force"), 0);
    EXPECT_THROW(make_scheme(named("modal_two_point"), with_loss(s, 1), matched), Refusal);
}

// ---- Quadratised contacts, each with a psi of its own.

const char* const variants[] = {"released", "raw"};
Settings quadratised(const char* variant, double rate, double tap_rate, int modes) {
    return {rate, tap_rate, modes, {{"variant", variant}}};
}

Scene over_two_bridges(double seconds, double beta = 0) {
    Scene s = lasting(read_scene("two_point_bridge"), seconds);
    LumpedBarrier second = std::get<LumpedBarrier>(s.strings[0].barriers[0]);
    second.position = 14e-3;
    s.strings[0].barriers.emplace_back(second);
    return beta > 0 ? with_loss(s, beta) : s;
}

TEST(SeveralQuadratisedPoints, OnePointThatIsInReachIsTheSchemeOfOnePoint) {
    const Scene release = lasting(c3_release(), 0.005), pluck = lasting(c3_pluck(), 0.005);
    for (const Scene& scene : {release, pluck})
        for (const double exponent : {1.0, 1.5})
            for (const char* variant : variants) {
                Scene one = scene;
                std::get<LumpedBarrier>(one.strings[0].barriers[0]).exponent = exponent;
                const Settings settings = quadratised(variant, 88200, 44100, 60);
                const jvari::Run a = run(named("modal_quadratised"), one, settings,
                                         {.energy = true}),
                                 b = run(named("modal_quadratised"),
                                         with_a_barrier_out_of_reach(one), settings,
                                         {.energy = true});
                EXPECT_EQ(fact(b, "contact_points"), 2);
                EXPECT_EQ(b.dofs, a.dofs + 1);
                for (int k = 0; k < a.trace.taps(); ++k)
                    EXPECT_LT(difference(b.trace.column(k), a.trace.column(k)), 1e-7)
                        << variant << " " << k;
                EXPECT_NEAR(fact(b, "smallest_contact_force"), fact(a, "smallest_contact_force"),
                            1e-6)
                    << variant;
            }
}

TEST(SeveralQuadratisedPoints, TheEnergyLedgerClosesInEveryStep) {
    for (const double beta : {0.0, 5.0})
        for (const Scene& s : {over_two_bridges(0.02, beta),
                               with_loss(lasting(read_scene("sitar_parabola"), 0.02), beta),
                               with_loss(lasting(c3_release(), 0.02), beta)})
            for (const char* variant : variants) {
                const jvari::Run r = run(named("modal_quadratised"), s,
                                         quadratised(variant, 128e3, 128e3, 80), {.energy = true});
                ASSERT_EQ(r.status.outcome, Outcome::ok) << variant << " " << s.name;
                EXPECT_LE(largest_residual(r), 1e-12) << variant << " " << s.name << " " << beta;
                for (const double d : r.trace.energy_column(2)) EXPECT_GE(d, -1e-16);
            }
}

TEST(SeveralQuadratisedPoints, TheReleasedNeverPullAndTheRawDo) {
    for (const Scene& s : {over_two_bridges(0.02), lasting(read_scene("sitar_parabola"), 0.02)})
        for (const char* variant : variants) {
            const jvari::Run r =
                run(named("modal_quadratised"), s, quadratised(variant, 128e3, 128e3, 80));
            if (std::string(variant) == "released")
                EXPECT_EQ(fact(r, "smallest_contact_force"), 0) << s.name;
            else EXPECT_LT(fact(r, "smallest_contact_force"), -1e-3) << variant << " " << s.name;
        }
}

// Against the same modes and points exact in time; the raw form does not converge, which is what it
// is for.
TEST(SeveralQuadratisedPoints, ConvergeToTheExactSolutionOfTheSamePoints) {
    for (const double beta : {0.0, 0.5}) {
        const Scene s = over_two_bridges(0.01, beta);
        const jvari::Run truth = run(named("exact_contact"), s, {0, 44100, 80, {}});
        ASSERT_EQ(truth.status.outcome, Outcome::ok);
        for (const char* variant : variants) {
            std::vector<double> error;
            for (const int rate : {4, 64}) {
                const jvari::Run r = run(named("modal_quadratised"), s,
                                         quadratised(variant, 44100.0 * rate, 44100, 80));
                error.push_back(difference(r.trace.column(1), truth.trace.column(1)));
            }
            if (std::string(variant) == "raw") EXPECT_GT(error[1], 1e-2) << beta;
            else EXPECT_LT(error[1], std::min(0.3 * error[0], 2e-3)) << variant << " " << beta;
        }
    }
}

TEST(SeveralQuadratisedPoints, KeepTheirEnergyInThreeLevelsAndWithMatchedCompliance) {
    const Scene s = over_two_bridges(0.005), losing = over_two_bridges(0.005, 0.5);
    constexpr double rate = 8 * 44100;
    const OptionValues three = {{"levels", "3"}}, matched = {{"compliance", "matched"}};
    const auto keeps = [&](const Scene& scene, const OptionValues& options) {
        const jvari::Run r =
            run(named("modal_quadratised"), scene, {rate, rate, 80, options}, {.energy = true});
        EXPECT_EQ(r.status.outcome, Outcome::ok);
        const auto stored = r.trace.energy_column(0), dissipated = r.trace.energy_column(2);
        for (long n = 1; n < r.trace.rows; ++n)
            ASSERT_NEAR(stored[n], stored[n - 1] - dissipated[n], 1e-13 * stored[0]) << n;
        EXPECT_GT(fact(r, "largest_contact_force"), 0);
    };
    keeps(s, three);
    keeps(losing, three);
    keeps(s, matched);
    EXPECT_THROW(make_scheme(named("modal_quadratised"), losing, {rate, rate, 80, matched}),
                 Refusal);
}

// The same points in both schemes.
// from the middle before the first node to the middle behind the last
Scene parabola_on_nodes(int intervals, int points) {
    Scene scene = read_scene("sitar_parabola");
    auto& barrier = std::get<ProfileBarrier>(scene.strings[0].barriers[0]);
    const double h = scene.strings[0].length / intervals;
    barrier.from = 0.5 * h;
    barrier.to = (points + 0.5) * h;
    return scene;
}

TEST(SeveralPoints, TheDistributedTwoPointSchemeGoesToTheSpatialNewtonAt4200Kilohertz) {
    constexpr double rate = 44100;
    struct Case {
        Scene scene;
        int modes;
        OptionValues options;
        int tap;
    };
    for (const Case& c : {Case{read_scene("two_point_bridge"), 94, {}, 1},
                          Case{read_scene("two_point_bridge"), 94, {}, 2},
                          Case{parabola_on_nodes(422, 8), 421, {{"points", "8"}}, 2},
                          Case{parabola_on_nodes(422, 8), 421, {{"points", "8"}}, 3}}) {
        const Scene scene = lasting(c.scene, 2e-3);
        const auto newton = [&](int times) {
            return run(named("modal_spatial_newton"), scene, {times * rate, rate, c.modes, {}});
        };
        const jvari::Run fine = newton(96);
        // of the spatial Newton itself
        const double uncertain =
            difference(newton(48).trace.column(c.tap), fine.trace.column(c.tap));
        double last = 1;
        for (const int times : {8, 32, 96}) {
            const jvari::Run r =
                run(named("modal_two_point"), scene, {times * rate, rate, c.modes, c.options});
            const double apart = difference(r.trace.column(c.tap), fine.trace.column(c.tap));
            EXPECT_LT(apart, 0.6 * last) << scene.name << " tap " << c.tap << " at " << times;
            last = apart;
        }
        EXPECT_LT(last, uncertain) << scene.name << " tap " << c.tap;
    }
}

TEST(SeveralPoints, TheDistributedTwoPointSchemeKeepsItsEnergyInEveryStep) {
    for (const Scene& whole : {read_scene("two_point_bridge"), parabola_on_nodes(422, 8)})
        for (const int times : {8, 32}) {
            const double rate = times * 44100.0;  // a row a step
            const Trace t =
                run(named("modal_two_point"), lasting(whole, 2e-3),
                    {rate, rate, whole.name == "sitar_parabola" ? 421 : 94, {}}, {.energy = true})
                    .trace;
            double worst = 0;
            for (long n = 1; n < t.rows; ++n)
                worst = std::max(worst, std::abs(t.energy_column(0)[n] - t.energy_column(0)[n - 1] -
                                                 t.energy_column(1)[n] + t.energy_column(2)[n]));
            EXPECT_LT(worst, 1e-13 * t.energy_column(0)[0]) << whole.name << " x" << times;
        }
}

}  // namespace
}  // namespace jvari
