// The spatial Newton scheme: exact where nothing touches, two forms that agree, a ledger that
// closes, and the papers' two bridges.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/contact/gradient_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"
#include "tests/schemes/dense_form.hpp"

namespace jvari {

extern const Descriptor modal_spatial_newton;

namespace {

using std::numbers::pi;

// Issanchou et al. 2016, section 4; B = 1.78e-5, the diameter agrees with steel
String issanchou_string() {
    String s;
    s.length = 1.002;
    s.linear_density = 1.17e-3;
    s.tension = 180.5;
    // B T L^2/pi^2 to 1e-7: the digits of the independent run below
    s.bending_stiffness = 3.2683823738748857e-4;
    s.damping = QualityFactorDamping{0.43e-3, 1.8e-5, 1.2, 0.0045, 0.000203};
    s.initial = TriangleInitial{0.501, 1.8e-3, 0.02};
    return s;
}

String tanpura_string() {  // van Walstijn et al. 2016, Table 1
    String s;
    s.length = 1.0;
    s.linear_density = 4.83e-4;
    s.tension = 33.1;
    s.bending_stiffness = 6.03e-5;
    s.damping = PolynomialDamping{0.6, 6.5e-3, 5.0e-6};
    return s;
}

Scene scene_of(String s, double duration) {
    Scene scene;
    scene.name = "test";
    scene.duration = duration;
    scene.strings.push_back(std::move(s));
    scene.taps = {{"y10mm", Quantity::displacement, 0, 0.01},
                  {"y03", Quantity::displacement, 0, 0.3},
                  {"nut", Quantity::nut_force, 0, 0}};
    return scene;
}

Scene two_point_bridge(double duration, double stiffness = 1e10) {  // K = 1e13, dx = 1 mm
    String s = issanchou_string();
    s.barriers.push_back(LumpedBarrier{6e-3, 0, 0, {stiffness}, 1.3, 0});
    return scene_of(s, duration);
}

Scene flat_bridge(double duration) {  // the 19 mm parabola of section 4.4
    String s = issanchou_string();
    s.barriers = {ProfileBarrier{ParabolaCurve{0.0065}, 0, 19e-3, {1e13}, 1.3, 0}};
    return scene_of(s, duration);
}

Scene tanpura(double duration) {
    String s = tanpura_string();
    s.barriers.push_back(LumpedBarrier{10e-3, 2e-3, 0, {4.39e8}, 1, 0});
    s.thread = Thread{5e-3, 1.2e-3, 1.2e5, 1.2, 0};
    s.initial = ModeInitial{1, 1.9e-3};
    Scene scene = scene_of(s, duration);
    scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    scene.taps.push_back({"thread", Quantity::thread_force, 0, 0});
    scene.taps.push_back({"driving", Quantity::driving_force, 0, 0});
    return scene;
}

Run in_form(const std::string& form, const Scene& scene, const Settings& settings,
            RunOptions options = {}) {
    if (form == "restricted") return run(modal_spatial_newton, scene, settings, options);
    using String = ThreePointModesBy<DenseForm>;
    Driver<String> scheme(
        std::make_unique<String>(spatial_problem(modal_spatial_newton, scene, settings)),
        steps_per_row(settings), rule_with<GradientRule>(settings));
    return run(scheme, scene, settings, options);
}
Run steps(const Scene& scene, double rate, double tap_rate, int modes,
          const char* form = "restricted", RunOptions options = {}) {
    return in_form(form, scene, {rate, tap_rate, modes, {}}, options);
}

double fact(const Run& r, const std::string& name) {
    for (const Fact& f : r.facts)
        if (f.name == name) return f.value;
    ADD_FAILURE() << "no fact " << name;
    return NAN;
}

double difference(const Trace& a, const Trace& b, int column) {  // relative L2
    double sum = 0, size = 0;
    for (long n = 0; n < std::min(a.rows, b.rows); ++n) {
        const double x = a.column(column)[n], y = b.column(column)[n];
        sum += (x - y) * (x - y);
        size += y * y;
    }
    return std::sqrt(sum / size);
}

struct Ledger {
    double worst_step, drift;  // relative to the stored energy at the start
};
Ledger ledger(const Trace& t) {
    const auto stored = t.energy_column(0), supplied = t.energy_column(1),
               dissipated = t.energy_column(2);
    double size = 0, worst = 0, sum = 0;
    for (double H : stored) size = std::max(size, std::abs(H));
    for (long n = 1; n < t.rows; ++n) {
        const double gap = stored[n] - stored[n - 1] - supplied[n] + dissipated[n];
        worst = std::max(worst, std::abs(gap));
        sum += gap;
    }
    return {worst / size, std::abs(sum) / size};
}

// ---- Free strings: the scheme is exact

struct Free {
    double y, v, nut;
};
Free closed_form(const String& s, int count, double x, double t) {
    const Modes m = modes_of(s, count);
    const auto y0 = initial_displacement(m, s), w = displacement_weights(m, x),
               n = nut_force_weights(m, s);
    Free out{0, 0, 0};
    for (int j = 0; j < count; ++j) {
        const double sigma = m.sigma[j], square = omega_squared_damped(m.omega0[j], sigma),
                     e = std::exp(-sigma * t);
        const double omega = std::sqrt(std::abs(square));
        const double c = square > 0 ? std::cos(omega * t) : std::cosh(omega * t),
                     q = square > 0 ? std::sin(omega * t) : std::sinh(omega * t);
        const double y = y0[j] * e * (c + sigma / omega * q),
                     v = -y0[j] * e * m.omega0[j] * m.omega0[j] / omega * q;
        out.y += w[j] * y;
        out.v += w[j] * v;
        out.nut += n[j] * y;
    }
    return out;
}

void is_exact(String s, double rate, int modes, double duration, const char* form) {
    Scene scene = scene_of(s, duration);
    scene.taps = {{"y", Quantity::displacement, 0, 0.3},
                  {"v", Quantity::velocity, 0, 0.3},
                  {"nut", Quantity::nut_force, 0, 0}};
    const auto r = steps(scene, rate, rate / 500, modes, form);
    const double size[] = {1e-3, 1.0, 0.5};
    for (long n = 0; n < r.trace.rows; n += 7) {
        const Free want = closed_form(s, modes, 0.3, double(n) * 500 / rate);
        EXPECT_NEAR(r.trace.column(0)[n], want.y, 1e-10 * size[0]) << n;
        EXPECT_NEAR(r.trace.column(1)[n], want.v, 1e-10 * size[1]) << n;
        EXPECT_NEAR(r.trace.column(2)[n], want.nut, 1e-10 * size[2]) << n;
    }
}

TEST(ModalSpatialNewton, AFreeStringIsExactAfterOneSecondWithAndWithoutLosses) {
    String s = tanpura_string();
    s.initial = TriangleInitial{0.2, 1e-3, 0.02};
    is_exact(s, 44100, 133, 1.0, "restricted");
    s.damping = NoDamping{};
    is_exact(s, 44100, 133, 1.0, "restricted");
}

// 2 - C loses omega dt^2: the plain recursion is detuned by 1e-7 here
TEST(ModalSpatialNewton, AFreeStringIsExactAfterAMillionSteps) {
    String s = tanpura_string();
    s.damping = NoDamping{};
    s.initial = TriangleInitial{0.2, 1e-3, 0.02};
    is_exact(s, 1e6, 12, 1.0, "restricted");
}

TEST(ModalSpatialNewton, OverdampedAndCriticalModesAreExactInEveryForm) {
    String s = tanpura_string();
    s.damping = PolynomialDamping{3 * pi * 131, 0, 0};  // mode 1 overdamped, the others not
    s.initial = TriangleInitial{0.2, 1e-3, 0.02};
    for (const char* form : {"dense", "restricted"}) is_exact(s, 44100, 20, 0.2, form);
}

TEST(ModalSpatialNewton, AModeAboveNyquistAliases) {
    String s = tanpura_string();
    s.damping = NoDamping{};
    s.bending_stiffness = 0;
    s.initial = ModeInitial{30, 1e-3};
    const double f = 30 * std::sqrt(33.1 / 4.83e-4) / 2, rate = 5000;  // 3927 Hz sounds as 1073 Hz
    const auto r = steps(scene_of(s, 0.1), rate, rate, 40);
    for (long n = 0; n < r.trace.rows; ++n)
        EXPECT_NEAR(
            r.trace.column(1)[n],
            1e-3 * std::sin(30 * pi * 0.3) * std::cos(2 * pi * (rate - f) * double(n) / rate),
            1e-12);
    EXPECT_EQ(fact(r, "modes_above_nyquist"), 40 - 19);  // mode 19: 2487 Hz
    EXPECT_EQ(fact(steps(scene_of(s, 0.01), 44100, 44100, 40), "modes_above_nyquist"), 0);
}

// ---- Forms

void forms_agree(const Scene& scene, double rate, int modes, const OptionValues& options = {}) {
    const auto restricted = in_form("restricted", scene, {rate, rate, modes, options});
    EXPECT_GT(fact(restricted, "deepest_penetration"), 1e-9);
    const auto dense = in_form("dense", scene, {rate, rate, modes, options});
    for (int k = 0; k < dense.trace.taps(); ++k)
        EXPECT_LT(difference(dense.trace, restricted.trace, k), 1e-10) << "tap " << k;
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
         {Case{two_point_bridge(1000 / 256e3), 333}, Case{flat_bridge(1000 / 256e3), 1001},
          Case{flat_bridge(1000 / 256e3), 1002}, Case{gap, 333}, Case{gap, 667},
          Case{tanpura(1000 / 256e3), 128}, Case{tanpura(1000 / 256e3), 133}}) {
        const auto dense = steps(c.scene, 256e3, 64e3, c.modes, "dense");
        for (auto left = targets; left != 0; left &= left - 1) {
            hwy::SetSupportedTargetsForTest(left & ~(left - 1));
            hwy::GetChosenTarget().Update(left & ~(left - 1));
            const auto restricted = steps(c.scene, 256e3, 64e3, c.modes, "restricted");
            for (int k = 0; k < dense.trace.taps(); ++k)
                EXPECT_LT(difference(restricted.trace, dense.trace, k), 1e-10)
                    << hwy::TargetName(left & ~(left - 1)) << " modes " << c.modes << " tap " << k;
        }
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(targets);
}

// ---- Energy

TEST(ModalSpatialNewton, TheLosslessLedgerClosesStepByStep) {
    RunOptions probed;
    probed.energy = true;
    for (Scene scene : {two_point_bridge(0.01), flat_bridge(0.01), tanpura(0.02)}) {
        scene.strings[0].damping = NoDamping{};
        if (scene.strings[0].thread) scene.strings[0].thread->damping = 0;
        const auto r = steps(scene, 256e3, 256e3, 333, "restricted", probed);
        const Ledger l = ledger(r.trace);
        EXPECT_GT(fact(r, "deepest_penetration"), 1e-9);
        EXPECT_LT(l.worst_step, 1e-11);
        EXPECT_LT(l.drift, 1e-10);
        for (double d : r.trace.energy_column(2)) EXPECT_EQ(d, 0);
        EXPECT_GE(fact(r, "smallest_contact_force"), 0);
    }
}

TEST(ModalSpatialNewton, TheLedgerClosesWithEveryLossAndAPluckAndContactLossOnlyDissipates) {
    RunOptions probed;
    probed.energy = true;
    Scene scene = tanpura(0.03);
    scene.strings[0].initial.reset();
    scene.strings[0].pluck = Pluck{-0.4, 10e-3, 3, 1e-3, 0.5, 1.0};
    std::get<LumpedBarrier>(scene.strings[0].barriers[0]).contact_loss = 5.0;
    for (const char* form : {"restricted", "dense"}) {
        const auto r = steps(scene, 88200, 44100, 60, form, probed);
        const Ledger l = ledger(r.trace);
        EXPECT_LT(l.worst_step, 1e-11) << form;
        double supplied = 0;
        for (double s : r.trace.energy_column(1)) supplied += s;
        EXPECT_GT(supplied, 1e-5);
        for (double d : r.trace.energy_column(2)) EXPECT_GE(d, 0);
    }
    Scene lossy = flat_bridge(0.02);
    lossy.strings[0].damping = NoDamping{};
    const double kept =
        steps(lossy, 256e3, 32e3, 333, "restricted", probed).trace.energy_column(0).back();
    std::get<ProfileBarrier>(lossy.strings[0].barriers[0]).contact_loss = 0.5;
    const auto r = steps(lossy, 256e3, 32e3, 333, "restricted", probed);
    double lost = 0;
    for (double d : r.trace.energy_column(2)) {
        EXPECT_GE(d, 0);
        lost += d;
    }
    EXPECT_GT(lost, 1e-3 * kept);
    EXPECT_LT(ledger(r.trace).worst_step, 1e-11);
}

// ---- The papers' scenes

TEST(ModalSpatialNewton, TheTwoPointBridgeIsThatOfAnIndependentProgram) {
    // N = 1002, 256 kHz; an independent implementation of the paper's equations gave these at 5, 10
    // and 20 ms.
    const double want[3][3] = {{3.58257398206063e-05, 0.00107608586696388, 0.650951326849124},
                               {3.60798459408338e-05, 0.00107483424304967, 0.629277914635052},
                               {3.732839902344e-05, 0.00106890659033257, 0.655039460661478}};
    const auto r = steps(two_point_bridge(0.02), 256e3, 32e3, 1001);
    const double size[] = {4e-5, 1e-3, 0.65};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(r.trace.column(k)[i == 0 ? 160 : 320 * i], want[i][k], 1e-8 * size[k])
                << i << " " << k;
    EXPECT_EQ(fact(r, "modes_above_nyquist"), 642);
}

TEST(ModalSpatialNewton, TheTwoPointBridgeConvergesAsTheRateRises) {
    // Displacement near the bridge; over 50 ms and against 4.096 MHz the errors are 0.72, 0.144,
    // 0.046, 0.0052 from 128 kHz to 1.024 MHz.
    const Scene scene = two_point_bridge(0.015);
    const auto fine = steps(scene, 2048e3, 64e3, 1001);
    double last = 10;
    for (double rate : {128e3, 256e3, 512e3}) {
        const double error = difference(steps(scene, rate, 64e3, 1001).trace, fine.trace, 0);
        EXPECT_LT(error, 0.5 * last) << rate;
        last = error;
    }
    EXPECT_LT(last, 0.05);
}

TEST(ModalSpatialNewton, AStiffBridgeYieldsATenthOfAMicrometreAndASoftOneTen) {
    EXPECT_LT(fact(steps(two_point_bridge(0.02), 1e6, 50e3, 1001), "deepest_penetration"), 2e-7);
    EXPECT_NEAR(fact(steps(two_point_bridge(0.02, 1e6), 1e6, 50e3, 1001), "deepest_penetration"),
                1.5e-5, 0.3e-5);
}

TEST(ModalSpatialNewton, TheTanpuraConvergesWithItsThread) {
    const Scene scene = tanpura(0.01);
    const auto fine = steps(scene, 44100 * 128, 44100, 133);
    double last = 1;
    for (int times : {1, 4, 16}) {
        const double error =
            difference(steps(scene, 44100 * times, 44100, 133).trace, fine.trace, 2);
        EXPECT_LT(error, 0.7 * last) << times;
        last = error;
    }
    EXPECT_LT(last, 2e-3);
}

TEST(ModalSpatialNewton, ANodeOfAProfileCarriesItsStiffnessDensityTimesTheSpacing) {
    const Scene point = two_point_bridge(5e-3);
    Scene profile = point;
    // node 6 of N = 1002, dx = 1 mm
    profile.strings[0].barriers = {ProfileBarrier{FlatCurve{}, 5.5e-3, 6.5e-3, {1e13}, 1.3, 0}};
    const auto a = steps(point, 256e3, 32e3, 1001), b = steps(profile, 256e3, 32e3, 1001);
    for (int k = 0; k < 3; ++k) EXPECT_LT(difference(a.trace, b.trace, k), 1e-10);
}

// ---- Orders

// Soft enough to be resolved: the string at rest compresses barrier and thread, a pluck pushes it,
// contact is lossy.
std::vector<double> orders(const Damping& damping) {
    String s = tanpura_string();
    s.damping = damping;
    s.barriers.push_back(LumpedBarrier{0.11, 0.05, 1e-3, {3e5}, 2, 2.0});
    s.thread = Thread{0.23, 0.05, 300, 0.5, 5e-4};
    s.pluck = Pluck{0.3, 8e-3, 2, 0, 0.6, 0.1};
    s.initial = ModeInitial{2, 1e-3};
    Scene scene = scene_of(s, 0.01);
    scene.taps.push_back({"v", Quantity::velocity, 0, 0.4});
    scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    scene.taps.push_back({"thread", Quantity::thread_force, 0, 0});
    const auto exact = steps(scene, 64 * 44100, 11025, 8), coarse = steps(scene, 88200, 11025, 8),
               finer = steps(scene, 176400, 11025, 8);
    std::vector<double> order;
    for (int k = 0; k < 6; ++k)
        order.push_back(std::log2(difference(coarse.trace, exact.trace, k) /
                                  difference(finer.trace, exact.trace, k)));
    return order;
}

TEST(ModalSpatialNewton, SmoothForcedMotionIsSecondOrderFromItsFirstStep) {
    for (double order : orders(NoDamping{})) EXPECT_NEAR(order, 2, 0.05);
}

// the paper's dt^2/m is e^{sigma dt} too much force on a mode
TEST(ModalSpatialNewton, LossesOfTheStringMakeForcedMotionFirstOrder) {
    for (double order : orders(PolynomialDamping{60, 0, 0})) EXPECT_NEAR(order, 1.15, 0.15);
}

TEST(ModalSpatialNewton, ContactForcesAreMeansOverTheIntervalThatEndsAtTheRow) {
    const Scene scene = tanpura(0.02);
    const auto every = steps(scene, 88200, 88200, 133), fourth = steps(scene, 88200, 22050, 133);
    for (int k : {3, 4, 5}) {
        EXPECT_EQ(every.trace.column(k)[0], 0);
        for (long n = 1; n < fourth.trace.rows; ++n) {
            double sum = 0;
            for (int i = 0; i < 4; ++i) sum += every.trace.column(k)[4 * n - i];
            EXPECT_NEAR(fourth.trace.column(k)[n], sum / 4, 1e-9);
        }
    }
}

// ---- Grids and refusals

TEST(ModalSpatialNewton, TheDefaultGridPutsThePointBarrierOnANode) {
    // 6 mm of 1.002 m: N = 167
    EXPECT_EQ(steps(two_point_bridge(0.001), 128e3, 32e3, 0).dofs, 2 * 166);
    EXPECT_EQ(steps(tanpura(0.001), 44100, 44100, 0).dofs, 2 * 133);
    EXPECT_EQ(fact(steps(flat_bridge(0.001), 128e3, 32e3, 0), "contact_points"), 8);
}

// and tends to the node as it nears it
TEST(ModalSpatialNewton, APointBarrierBetweenNodesActsThroughItsModes) {
    Scene on = two_point_bridge(0.003), off = on;
    std::get<LumpedBarrier>(off.strings[0].barriers[0]).position += 1e-8;
    const auto a = steps(on, 256e3, 32e3, 333), b = steps(off, 256e3, 32e3, 333);
    for (int k = 0; k < 3; ++k) EXPECT_LT(difference(b.trace, a.trace, k), 1e-3);
}

void refuses(const Scene& scene, int modes, const std::string& why, double tap_rate = 44100,
             const OptionValues& options = {}) {
    try {
        make_scheme(modal_spatial_newton, scene, {44100, tap_rate, modes, options});
        ADD_FAILURE() << "made in spite of: " << why;
    } catch (const Refusal& r) {
        EXPECT_NE(std::string(r.what()).find(why), std::string::npos) << r.what();
    }
}

TEST(ModalSpatialNewton, WhatItCannotRepresentIsRefusedByName) {
    Scene scene = tanpura(0.01);
    scene.strings[0].barriers.push_back(scene.strings[0].barriers[0]);
    refuses(scene, 133, "coupled");
    scene = flat_bridge(0.01);
    scene.strings[0].thread = Thread{5e-3, 1e-3, 1e5, 1, 0};
    refuses(scene, 1001, "thread to one contact point");
    refuses(flat_bridge(0.01), 20, "no node");
    scene = two_point_bridge(0.01);
    scene.strings[0].barriers.push_back(scene.strings[0].barriers[0]);
    refuses(scene, 1001, "node 6");
    refuses(tanpura(0.01), 133, "unknown option", 44100, {{"gird", "5"}});
    refuses(tanpura(0.01), 133, "whole multiple", 48000);
}

}  // namespace
}  // namespace jvari
