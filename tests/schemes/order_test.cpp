// Errors fall as the rate rises: strings, contact rules and options against scenes, each against a
// truth of another kind. jvari check asks the same of every scheme as it is by default, on three
// smooth scenes.
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/claims.hpp"

namespace jvari {
namespace {

const Forms
    // the tuned theta is of higher order where stiffness is small
    plain_grids{"finite_difference_explicit", "finite_difference_theta theta=0.8",
                "finite_difference_hamiltonian"},
    quadratised{"modal_quadratised", "modal_quadratised levels=3"},
    explicit_penalty{"modal_explicit_penalty"}, two_point{"modal_two_point"},
    spatial_newton{"modal_spatial_newton"}, tension{"modal_tension"};

Scene with_stiffness(Scene scene, double k) {
    barrier(scene).stiffness.k = k;
    return scene;
}
Scene without_barrier(Scene scene) {
    scene.strings.front().barriers.clear();
    scene.taps = {{"y", Quantity::displacement, 0, 0.3},
                  {"nut", Quantity::nut_force, 0, 0},
                  {"thread", Quantity::thread_force, 0, 0}};
    return scene;
}

// Stiffness so low that time and space steps can be halved together within the explicit limit.
Scene smooth() {
    Scene scene = with_damping(lasting(c3_free(), 0.01), PolynomialDamping{3, 0, 0});
    String& s = scene.strings.front();
    s.bending_stiffness = 1e-5;
    s.start = TriangleShape{0.37, 1e-3, 0.4};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0},
                  {"y", Quantity::displacement, 0, 0.2718},
                  {"v", Quantity::velocity, 0, 0.2718}};
    return scene;
}
Scene smooth_pluck() {
    Scene scene = smooth();
    scene.strings.front().start.reset();
    scene.strings.front().pluck = Pluck{-0.4, 6e-3, 4.0, 0.5e-3, 0.31, 0.3};
    return scene;
}
Scene soft_thread_and_barrier() {  // the barrier is never left
    Scene scene = smooth();
    String& s = scene.strings.front();
    s.thread = Thread{0.31, 0.3, 300, 0.1, 0.2e-3};
    s.barriers = {LumpedBarrier{0.62, 0.4, 3e-3, {1e3}, 1.5, 0}};
    scene.taps.push_back({"thread", Quantity::thread_force, 0, 0});
    scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    return scene;
}

// Soft enough to be resolved: the string at rest compresses barrier and thread, a pluck pushes it,
// contact is lossy.
Scene all_smoothly(const Damping& damping) {
    Scene scene = with_damping(lasting(c3_free(), 0.01), damping);
    String& s = scene.strings.front();
    s.barriers.push_back(LumpedBarrier{0.11, 0.05, 1e-3, {3e5}, 2, 2.0});
    s.thread = Thread{0.23, 0.05, 300, 0.5, 5e-4};
    s.pluck = Pluck{0.3, 8e-3, 2, 0, 0.6, 0.1};
    s.start = ModeShape{2, 1e-3};
    scene.taps = {
        {"y10mm", Quantity::displacement, 0, 0.01}, {"y03", Quantity::displacement, 0, 0.3},
        {"nut", Quantity::nut_force, 0, 0},         {"v", Quantity::velocity, 0, 0.4},
        {"bridge", Quantity::bridge_force, 0, 0},   {"thread", Quantity::thread_force, 0, 0}};
    return scene;
}

Scene in_a_soft_bed() {  // psi = sqrt(K) eta is linear
    Scene scene = lasting(lossless(c3_release()), 1e-3);
    barrier(scene) = {0.2, 2e-3, 1e-2, {50}, 1, 0};
    return scene;
}
Scene pluck_alone() {
    Scene scene = lasting(without_barrier(c3_pluck()), 5e-3);
    scene.strings.front().pluck->duration = 2e-3;
    scene.taps.erase(scene.taps.begin() + 1);
    return scene;
}

Scene touched_in_three_places() {  // softly, and each takes some of the energy
    Scene scene = lasting(c3_release(), 0.01);
    scene.strings.front().barriers = {LumpedBarrier{10e-3, 2e-3, 0, {1e4}, 1.5, 20},
                                      LumpedBarrier{0.03, 0, 1e-5, {2e4}, 1, 5},
                                      LumpedBarrier{0.4, 0.02, 1e-4, {5e3}, 2, 0}};
    return scene;
}

Scene over_a_parabola(double beta) {  // which is met within 2 ms
    Scene scene = lasting(read_scene("sitar_parabola"), 2e-3);
    const double L = scene.strings.front().length;
    scene.taps = {{"y", Quantity::displacement, 0, 0.1 * L}};
    scene.strings.front().start = TriangleShape{0.12 * L, 1.8e-3, 0.1 * L};
    return with_loss(scene, beta);
}
Scene over_nodes_of_a_parabola() {
    Scene scene = lasting(c3_free(), 4e-3);
    String& s = scene.strings[0];
    s.length = 0.8;
    s.linear_density = 5e-4;
    s.tension = 32;
    s.bending_stiffness = 0;
    s.barriers = {ProfileBarrier{ParabolaCurve{0.02}, 0, 0.1, {1e9}, 1.3, 0}};
    s.start = TriangleShape{0.2, 3e-3, 0.05};
    s.damping = PolynomialDamping{2, 0, 0};
    scene.taps = {{"y03", Quantity::displacement, 0, 0.24}};
    return scene;
}

// A string falls on a broad soft obstacle, which takes more than half of its energy in 20 ms.
Scene on_a_broad_loss() {
    Scene scene = lasting(lossless(c3_free()), 0.02);
    scene.strings[0].start = ModeShape{1, 1.9e-3};
    scene.strings[0].barriers = {LumpedBarrier{0.4, 0.2, -5e-4, {1e7}, 1.5, 2}};
    scene.taps = {{"bridge", Quantity::bridge_force, 0, 0}};
    return scene;
}

Scene struck_with_loss() {
    Scene scene = lasting(lossless(c3_free()), 0.01);
    scene.strings[0].start.reset();
    scene.strings[0].masses = {{5e-3, 0.3, 0.02, 1, 0, 1e5, 1.5, 0.5}};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}};
    return scene;
}

Scene glide(double seconds) { return lasting(read_scene("steel_string_glide"), seconds); }
Scene on_a_fret() {
    Scene scene = glide(0.01);
    scene.strings[0].barriers = {LumpedBarrier{0.0364, 2e-3, -5e-4, {1e7}, 1, 0},
                                 LumpedBarrier{0.1, 2e-3, -1e-3, {1e7}, 1.3, 0}};
    scene.taps.push_back({"fret", Quantity::bridge_force, 0, 0});
    return scene;
}

std::vector<ConvergenceClaim> convergence_claims() {
    using Of = ConvergenceClaim;
    const Scene release = lasting(c3_release(), 0.01);
    const Scene grid_contact =
        lasting(with_damping(c3_release(), PolynomialDamping{5, 0, 0}), 8e-3);
    const Scene soft_power = with_stiffness(with_exponent(release, 1.7), 3e8);
    return {
        // nut force, 0-50 ms; a separate implementation of the scheme and of the exact solution
        Of("TwoPointErrsByWhatAnIndependentProgramHas", two_point, lasting(c3_release(), 0.05),
           {133, 0, 44100}, {1, 4, 16, 64}, {"exact_contact", 0},
           {.within = 0.05, .errors = {6.8e-2, 4.1e-3, 7.1e-4, 1.8e-4}}),
        Of("TwoPointOnAParabolaOfTheSamePoints", {"modal_two_point points=4"}, over_a_parabola(0),
           {30, 0, 44100}, {4, 16, 64}, {"sundials nodes=4", 0}, {.fall = 0.5, .last = 1e-3}),
        Of("TwoPointOnAParabolaThatLoses", {"modal_two_point points=4"}, over_a_parabola(5),
           {30, 0, 44100}, {4, 16, 64}, {"sundials nodes=4", 0}, {.fall = 0.5, .last = 1e-3}),
        Of("QuadratisedReleases", quadratised, release, {133, 0, 44100}, {1, 4, 16, 64},
           {"modal_two_point", 256}, {.first = 0.4, .fall = 0.4, .last = 2e-4}),
        Of("QuadratisedInSoftPowerLaws", quadratised, soft_power, {133, 0, 44100}, {64},
           {"modal_two_point", 64}, {.last = 1e-2}),
        // the thread acts from t = 0: without its half step the error is of first order
        Of("QuadratisedStartsRightWhereTheThreadBendsIt", {quadratised[1]},
           lasting(without_barrier(c3_release()), 5e-3), {133, 0, 44100}, {4, 16},
           {"modal_two_point", 256}, {.fall = 0.1, .last = 1e-3}, {1}),
        Of("QuadratisedInTwoLevelsIsPluckedAsTwoPoint", {quadratised[0]}, pluck_alone(),
           {133, 0, 44100}, {1}, {"modal_two_point", 1}, {.last = 1e-11}, {0, 1}),
        Of("QuadratisedInThreeLevelsIsPluckedAsTwoPoint", {quadratised[1]}, pluck_alone(),
           {133, 0, 44100}, {16}, {"modal_two_point", 64}, {.last = 1e-3}, {0, 1}),
        Of("QuadratisedInLastingLinearContactIsTwoPoint",
           {"modal_quadratised", "modal_quadratised variant=raw"}, in_a_soft_bed(), {30, 0, 44100},
           {1}, {"modal_two_point", 1}, {.last = 1e-11}),
        // started inside the barrier: second order, so the first step is right as well
        Of("QuadratisedInThreeLevelsInLastingLinearContact", {quadratised[1]}, in_a_soft_bed(),
           {30, 0, 44100}, {4, 16}, {"modal_two_point", 256}, {.fall = 1 / 12.0, .last = 1e-3},
           {1}),
        Of("QuadratisedOnTwoPoints", {"modal_quadratised"}, over_two_bridges(0.01, 0),
           {80, 0, 44100}, {4, 64}, {"exact_contact", 0}, {.fall = 0.3, .last = 2e-3}, {1}),
        Of("QuadratisedOnTwoPointsThatLose", {"modal_quadratised"}, over_two_bridges(0.01, 0.5),
           {80, 0, 44100}, {4, 64}, {"exact_contact", 0}, {.fall = 0.3, .last = 2e-3}, {1}),
        // Displacement near the bridge; over 50 ms and against 4.096 MHz the errors are 0.72,
        // 0.144, 0.046, 0.0052 from 128 kHz to 1.024 MHz.
        Of("NewtonOnATwoPointBridge", spatial_newton,
           lasting(read_scene("two_point_bridge"), 0.015), {1001, 0, 64e3}, {2, 4, 8},
           {spatial_newton[0], 32}, {.first = 5, .fall = 0.5, .last = 0.05}),
        Of("NewtonOverBridgeAndThread", spatial_newton, release, {133, 0, 44100}, {1, 4, 16},
           {spatial_newton[0], 128}, {.first = 0.7, .fall = 0.7, .last = 2e-3}),
        Of("NewtonWhereAllIsSmooth", spatial_newton, all_smoothly(NoDamping{}), {8, 0, 11025},
           {8, 16}, {spatial_newton[0], 256}, {.order = 2, .within = 0.05}, {0, 1, 2, 3, 4, 5}),
        // the paper's dt^2/m is e^{sigma dt} too much force on a mode
        Of("NewtonWithLossesWhereAllIsSmooth", spatial_newton,
           all_smoothly(PolynomialDamping{60, 0, 0}), {8, 0, 11025}, {8, 16},
           {spatial_newton[0], 256}, {.order = 1.15, .within = 0.15}, {0, 1, 2, 3, 4, 5}),
        Of("NewtonOnNodesOfAParabola", spatial_newton, over_nodes_of_a_parabola(), {47, 0, 44100},
           {64, 128, 256, 512}, {"sundials nodes=grid", 0},
           {.last = 4e-6, .order = 2, .within = 0.03}),
        Of("PenaltyInSoftContact", explicit_penalty, with_stiffness(release, 1e4), {133, 0, 44100},
           {8, 16, 32}, {"modal_two_point", 64}, {.first = 0.5, .fall = 0.5, .last = 1e-3}),
        Of("PenaltyInThreePlaces", explicit_penalty, touched_in_three_places(), {60, 0, 44100},
           {8, 16, 32}, {"modal_two_point", 128}, {.first = 0.7, .fall = 0.7, .last = 2e-3},
           {0, 1, 2}),
        Of("GridsOfALinearString", plain_grids, smooth(), {0, 100, 44100}, {1, 2, 4},
           {"exact_linear", 0, 60}, {.order = 2, .within = 0.1}, {0, 1, 2}),
        Of("GridsOfAPluckedString", plain_grids, smooth_pluck(), {0, 100, 44100}, {1, 2, 4},
           {"modal_two_point", 64, 80}, {.order = 2, .within = 0.1}, {1}),
        // the footprint's kinks make the velocity less regular than order two needs
        Of("GridsOnASoftThreadAndABarrierNeverLeft", plain_grids, soft_thread_and_barrier(),
           {0, 100, 44100}, {1, 2, 4}, {"modal_two_point", 64, 80}, {.order = 2, .within = 0.1},
           {1, 3, 4}),
        Of("GridsOnC3", grids, lasting(c3_release(), 0.02), {0, 0, 44100}, {1, 4, 16},
           {"exact_contact", 0, 300}, {.first = 0.85, .fall = 0.85, .last = 6e-2}),
        Of("ThetaOnC3", {grids[1]}, lasting(c3_release(), 0.02), {0, 0, 44100}, {16},
           {"exact_contact", 0, 300}, {.last = 1.2e-2}),
        Of("LossesUnderAHammerAreOfTheSecondOrder",
           {"modal_two_point", "modal_two_point_trapezoidal", "modal_three_point"},
           struck_with_loss(), {40, 0, 44100}, {4, 16, 64}, {"exact_contact", 0},
           {.order = 2, .within = 0.25}),
        Of("ThreePointGridsOnABroadLoss", {grids[0], grids[1]}, on_a_broad_loss(), {0, 0, 44100},
           {4, 16}, {"exact_contact", 0, 300}, {.order = 1.9, .within = 0.3, .left = 0.02}),
        Of("TensionFallsAsTheSquareOfTheStep", tension, glide(0.02), {20, 0, 44100}, {4, 16},
           {"sundials", 0}, {.last = 1e-3, .order = 2, .within = 0.085}, {1}),
        // The tension of mode 1 pulls a high mode: a shift of the pitch by 1/2 dT beta^2/(mu omega)
        // at any rate. By a gain dt^2/m the mode at x = omega dt/2 would be pulled 2x/sin 2x times
        // as far, and the error were above a tenth.
        Of("TensionTunesHighModesByTheGainOfAnImpulse", tension,
           with_damping(glide(0.02), NoDamping{}), {50, 0, 44100}, {1}, {"sundials", 0},
           {.last = 0.03}),
        Of("TensionOnAFret", tension, on_a_fret(), {20, 0, 44100}, {8, 64}, {"sundials", 0},
           {.fall = 0.2, .last = 1e-2}, {0, 1}),
    };
}

class Errors : public testing::TestWithParam<ConvergenceClaim> {};
TEST_P(Errors, Fall) { holds(GetParam()); }
INSTANTIATE_TEST_SUITE_P(, Errors, testing::ValuesIn(convergence_claims()),
                         name_of<ConvergenceClaim>);

TEST(ErrorsOfRawQuadratisation, StayWhateverTheRate) {
    const Scene release = lasting(c3_release(), 0.01);
    const auto stays = [](const std::string& form, const Scene& scene, int modes, int tap,
                          const jvari::Run& truth, double least) {
        EXPECT_GT(
            apart(play(form + " variant=raw", scene, {64 * 44100, 44100, modes, {}}), truth, tap),
            least)
            << form << " on " << scene.name;
    };
    const auto truth = play("modal_two_point", release, {256 * 44100, 44100, 133, {}});
    for (const std::string& form : quadratised) stays(form, release, 133, 0, truth, 0.03);
    for (const double beta : {0.0, 0.5}) {
        const Scene two = over_two_bridges(0.01, beta);
        stays(quadratised[0], two, 80, 1, play("exact_contact", two, {0, 44100, 80, {}}), 1e-2);
    }
}

TEST(ErrorsOfTheta, AtItsTunedValueAreFarSmallerThanAtOthers) {
    const auto truth = play("exact_linear", smooth(), {0, 44100, 60, {}});
    const auto error = [&](const std::string& theta) {
        return apart(play(grids[1] + theta + " grid=100", smooth(), {44100, 44100, 0, {}}), truth,
                     1);
    };
    EXPECT_LT(error(""), error(" theta=0.8") / 30);
}

// The same points in both schemes, from the middle before the first node to the middle behind the
// last. As near as the spatial Newton is to itself.
TEST(ErrorsOfTwoPointOnProfiles, FallToThoseOfTheSpatialNewtonAt4200kHz) {
    Scene parabola = read_scene("sitar_parabola");
    auto& profile = std::get<ProfileBarrier>(parabola.strings[0].barriers[0]);
    const double h = parabola.strings[0].length / 422;
    profile.from = 0.5 * h, profile.to = 8.5 * h;
    const auto fall = [](const Scene& scene, int modes, const std::string& form,
                         std::vector<int> taps) {
        const auto fine = [&](double times) {
            return play(spatial_newton[0], scene, {times * 44100, 44100, modes, {}});
        };
        const auto half = fine(48), whole = fine(96);
        for (const int tap : taps)
            holds(ConvergenceClaim{"",
                                   {form},
                                   scene,
                                   {modes},
                                   {8, 32, 96},
                                   {spatial_newton[0], 96},
                                   {.first = 0.6, .fall = 0.6, .last = apart(half, whole, tap)},
                                   {tap}});
    };
    fall(lasting(read_scene("two_point_bridge"), 2e-3), 94, "modal_two_point", {1, 2});
    fall(lasting(parabola, 2e-3), 421, "modal_two_point points=8", {2, 3});
}

}  // namespace
}  // namespace jvari
