// The spatial Newton scheme: two forms that agree, and the papers' two bridges.
#include <hwy/targets.h>

#include <numbers>

#include "scenes/scene_file.hpp"
#include "schemes/contact/gradient_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"
#include "tests/schemes/dense_form.hpp"

namespace jvari {
namespace {

using std::numbers::pi;

const std::string newton = "modal_spatial_newton";

Scene two_point_bridge(double duration, double stiffness = 1e10) {  // K = 1e13, dx = 1 mm
    Scene scene = lasting(read_scene("two_point_bridge"), duration);
    barrier(scene).stiffness.k = stiffness;
    return scene;
}
Scene flat_bridge(double duration) {  // the 19 mm parabola of section 4.4
    Scene scene = lasting(read_scene("two_point_bridge"), duration);
    scene.strings[0].barriers = read_scene("sitar_parabola").strings[0].barriers;
    return scene;
}
Scene tanpura(double duration) {
    Scene scene = lasting(c3_release(), duration);
    scene.taps.push_back({"driving", Quantity::driving_force, 0, 0});
    return scene;
}

Run dense(const Scene& scene, const Settings& settings, const RunOptions& options = {}) {
    using String = ThreePointModesBy<DenseForm>;
    Driver<String> scheme(std::make_unique<String>(spatial_problem(named(newton), scene, settings)),
                          steps_per_row(settings), rule_with<GradientRule>(settings));
    return run(scheme, scene, settings, options);
}
Run stepped(const Scene& scene, double rate, double tap_rate, int modes) {
    return play(newton, scene, {rate, tap_rate, modes, {}});
}

TEST(ModalSpatialNewton, OverdampedModesAreExactInTheDenseForm) {
    Scene scene = lasting(c3_free(), 0.2);
    scene.strings[0].damping = PolynomialDamping{3 * pi * 131, 0, 0};  // mode 1, the others not
    scene.strings[0].start = TriangleShape{0.2, 1e-3, 0.02};
    scene.taps.push_back({"v", Quantity::velocity, 0, 0.3});
    const auto r = dense(scene, {44100, 88.2, 20, {}}),
               truth = play("exact_linear", scene, {0, 88.2, 20, {}});
    for (int k = 0; k < 3; ++k)
        EXPECT_LT(largest_difference(r.trace.column(k), truth.trace.column(k)),
                  1e-10 * largest(truth.trace.column(k)))
            << k;
}

// Footprints and a thread are no nodes: each force moves every reading.
TEST(ModalSpatialNewton, SolvesForContactsBetweenNodesAndAThreadTogether) {
    Scene scene = lasting(c3_release(), 0.01);
    barrier(scene).stiffness.k = 1e6;
    scene.strings[0].barriers.push_back(LumpedBarrier{14e-3, 3e-3, -2e-6, {1e6}, 1, 0});
    scene.strings[0].thread->stiffness = 1e4;
    const auto truth = play("exact_contact", scene, {0, 44100, 40, {}});
    const auto at = [&](double rate) {
        RunOptions options;
        options.energy = true;
        return run(named(newton), scene, {rate, 44100, 40, {}}, options);
    };
    const auto coarse = at(8 * 44100), fine = at(64 * 44100);
    for (std::size_t k = 0; k < scene.taps.size(); ++k)
        EXPECT_LT(apart(fine, truth, k), std::max(1e-6, 0.1 * apart(coarse, truth, k)))
            << scene.taps[k].name;
    EXPECT_LE(ledger(coarse.trace).sum, 1e-10);
}

TEST(ModalSpatialNewton, AModeAboveNyquistAliases) {
    Scene scene = lasting(lossless(c3_free()), 0.1);
    scene.strings[0].bending_stiffness = 0;
    scene.strings[0].start = ModeShape{30, 1e-3};
    scene.taps = {{"y", Quantity::displacement, 0, 0.31}};
    const double f = 30 * std::sqrt(33.1 / 4.83e-4) / 2, rate = 5000;  // 3927 Hz sounds as 1073 Hz
    const auto r = stepped(scene, rate, rate, 40);
    for (long n = 0; n < r.trace.rows; ++n)
        EXPECT_NEAR(
            r.trace.column(0)[n],
            1e-3 * std::sin(30 * pi * 0.31) * std::cos(2 * pi * (rate - f) * double(n) / rate),
            1e-12);
    EXPECT_EQ(fact(r, "modes_above_nyquist"), 40 - 19);  // mode 19: 2487 Hz
    EXPECT_EQ(fact(stepped(lasting(scene, 0.01), 44100, 44100, 40), "modes_above_nyquist"), 0);
}

// ---- Forms

void forms_agree(const Scene& scene, double rate, int modes, const OptionValues& options = {}) {
    const Settings settings{rate, rate, modes, options};
    const auto restricted = run(named(newton), scene, settings), full = dense(scene, settings);
    EXPECT_GT(fact(restricted, "deepest_penetration"), 1e-9);
    for (int k = 0; k < full.trace.taps(); ++k)
        EXPECT_LT(apart(full, restricted, k), 1e-10) << "tap " << k;
}

TEST(ModalSpatialNewton, TheTwoFormsAgreeOverAThousandSteps) {
    for (const Scene& scene : {two_point_bridge(1000 / 256e3), flat_bridge(1000 / 256e3)})
        forms_agree(scene, 256e3, 333);  // contact from 1.3 ms on
    forms_agree(tanpura(1000 / 88200.0), 88200, 133);
}

TEST(ModalSpatialNewton, TheTwoFormsAgreeWhereManyPointsLieBetweenNodes) {
    for (const char* points : {"3", "5", "6", "8"}) {
        Scene scene = flat_bridge(1000 / 256e3);
        scene.strings[0].pluck = Pluck{0.1, 2e-3, 2, 1e-4, 0.6, 0.1};
        forms_agree(scene, 256e3, 60, {{"compliance", "matched"}, {"points", points}});
    }
}

TEST(ModalSpatialNewton, EveryInstructionSetOfThisMachineAgreesWithTheDenseForm) {
    // runs of 3 and 2 nodes, one alone, and a pluck beside them; later rounding has grown
    Scene gap = flat_bridge(600 / 256e3);
    gap.strings[0].barriers = {ProfileBarrier{FlatCurve{}, 0.011, 0.019, {1e13}, 1.3, 0},
                               ProfileBarrier{FlatCurve{}, 0.002, 0.0065, {1e13}, 1.3, 0},
                               LumpedBarrier{10 * 1.002 / 334, 0, 0, {1e10}, 1.3, 0}};
    gap.strings[0].pluck = Pluck{0.1, 2e-3, 2, 1e-4, 0.6, 0.1};
    struct Case {
        Scene scene;
        int modes;  // N even and odd, one step of padding and none
    };
    const auto targets = hwy::SupportedTargets();
    for (const Case& c :
         {Case{two_point_bridge(1000 / 256e3), 333}, Case{flat_bridge(1000 / 256e3), 505},
          Case{flat_bridge(1000 / 256e3), 506}, Case{gap, 333}, Case{gap, 667},
          Case{tanpura(1000 / 256e3), 128}, Case{tanpura(1000 / 256e3), 133}}) {
        const auto full = dense(c.scene, {256e3, 64e3, c.modes, {}});
        for (auto left = targets; left != 0; left &= left - 1) {
            hwy::SetSupportedTargetsForTest(left & ~(left - 1));
            hwy::GetChosenTarget().Update(left & ~(left - 1));
            const auto restricted = stepped(c.scene, 256e3, 64e3, c.modes);
            for (int k = 0; k < full.trace.taps(); ++k)
                EXPECT_LT(apart(restricted, full, k), 1e-10)
                    << hwy::TargetName(left & ~(left - 1)) << " modes " << c.modes << " tap " << k;
        }
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(targets);
}

// ---- Energy

TEST(ModalSpatialNewton, TheLedgerOfBothFormsClosesWithEveryLossAndAPluck) {
    Scene scene = with_loss(tanpura(0.03), 5.0);
    scene.strings[0].start.reset();
    scene.strings[0].pluck = Pluck{-0.4, 10e-3, 3, 1e-3, 0.5, 1.0};
    const Settings settings{88200, 44100, 60, {}};
    const RunOptions probed{.energy = true};
    for (const jvari::Run& r :
         {run(named(newton), scene, settings, probed), dense(scene, settings, probed)}) {
        const Ledger l = ledger(r.trace);
        EXPECT_LT(l.row, 1e-11);
        EXPECT_GE(l.least_loss, 0);
        const auto supplied = r.trace.energy_column(1);
        EXPECT_GT(std::accumulate(supplied.begin(), supplied.end(), 0.0), 1e-5);
    }
}

// ---- The papers' scenes

TEST(ModalSpatialNewton, TheTwoPointBridgeIsThatOfAnIndependentProgram) {
    // N = 1002, 256 kHz; an independent implementation of the paper's equations gave these at 5, 10
    // and 20 ms.
    const double want[3][3] = {{3.58257398206063e-05, 0.00107608586696388, 0.650951326849124},
                               {3.60798459408338e-05, 0.00107483424304967, 0.629277914635052},
                               {3.732839902344e-05, 0.00106890659033257, 0.655039460661478}};
    Scene scene = two_point_bridge(0.02);
    // B T L^2/pi^2 to 1e-7: its digits
    scene.strings[0].bending_stiffness = 3.2683823738748857e-4;
    const auto r = stepped(scene, 256e3, 32e3, 1001);
    const double size[] = {4e-5, 1e-3, 0.65};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(r.trace.column(k)[i == 0 ? 160 : 320 * i], want[i][k], 1e-8 * size[k])
                << i << " " << k;
    EXPECT_EQ(fact(r, "modes_above_nyquist"), 642);
}

TEST(ModalSpatialNewton, AStiffBridgeYieldsATenthOfAMicrometreAndASoftOneTen) {
    EXPECT_LT(fact(stepped(two_point_bridge(0.02), 1e6, 50e3, 1001), "deepest_penetration"), 2e-7);
    EXPECT_NEAR(fact(stepped(two_point_bridge(0.02, 1e6), 1e6, 50e3, 1001), "deepest_penetration"),
                1.5e-5, 0.3e-5);
}

TEST(ModalSpatialNewton, ANodeOfAProfileCarriesItsStiffnessDensityTimesTheSpacing) {
    const Scene point = two_point_bridge(5e-3);
    Scene profile = point;
    // node 6 of N = 1002, dx = 1 mm
    profile.strings[0].barriers = {ProfileBarrier{FlatCurve{}, 5.5e-3, 6.5e-3, {1e13}, 1.3, 0}};
    const auto a = stepped(point, 256e3, 32e3, 1001), b = stepped(profile, 256e3, 32e3, 1001);
    for (int k = 0; k < 3; ++k) EXPECT_LT(apart(a, b, k), 1e-10);
}

// ---- Grids

TEST(ModalSpatialNewton, TheDefaultGridPutsThePointBarrierOnANode) {
    // 6 mm of 1.002 m: N = 167
    EXPECT_EQ(stepped(two_point_bridge(0.001), 128e3, 32e3, 0).dofs, 2 * 166);
    EXPECT_EQ(stepped(tanpura(0.001), 44100, 44100, 0).dofs, 2 * 133);
    EXPECT_EQ(fact(stepped(flat_bridge(0.001), 128e3, 32e3, 0), "contact_points"), 8);
}

// and tends to the node as it nears it
TEST(ModalSpatialNewton, APointBarrierBetweenNodesActsThroughItsModes) {
    Scene on = two_point_bridge(0.003), off = on;
    std::get<LumpedBarrier>(off.strings[0].barriers[0]).position += 1e-8;
    const auto a = stepped(on, 256e3, 32e3, 333), b = stepped(off, 256e3, 32e3, 333);
    for (int k = 0; k < 3; ++k) EXPECT_LT(apart(b, a, k), 1e-3);
}

}  // namespace
}  // namespace jvari
