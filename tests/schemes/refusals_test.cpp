// What a scheme cannot do with a scene that it represents, or with an option: it refuses before the
// first step, in a sentence that says why. That it refuses a feature that it has not, and names it,
// is a promise of jvari check.
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/sitar_scenes.hpp"

namespace jvari {
namespace {

struct Refused {
    std::string form;
    Scene scene;
    Settings settings;
    const char* why;
};

Scene with_barriers(Scene scene, std::vector<Barrier> barriers) {
    scene.strings[0].barriers = std::move(barriers);
    return scene;
}
Scene with_string(Scene scene, void (*change)(String&)) {
    change(scene.strings[0]);
    return scene;
}

std::vector<Refused> refused() {
    const Scene c3 = c3_release(), free = c3_free(), bridge_scene = read_scene("two_point_bridge"),
                parabola = read_scene("sitar_parabola"), sitar = sitar_scene();
    const Barrier point = bridge_scene.strings[0].barriers[0];
    LumpedBarrier second = std::get<LumpedBarrier>(point);
    second.position = 14e-3;
    const Scene two_bridges = with_barriers(bridge_scene, {point, second});
    const Scene rigid_bridge = read_scene(
        "two_point_bridge", {"string.0.barrier.0.exponent=1", "string.0.start.smoothing=0.1",
                             "string.0.barrier.0.stiffness=rigid"});
    Scene inside = rigid_bridge, beside = rigid_bridge;
    barrier(inside).height = 1e-3;
    beside.strings[0].barriers.push_back(LumpedBarrier{0.02, 0, 0, {1e8}, 1, 0});
    const Scene flat = with_barriers(c3, {ProfileBarrier{FlatCurve{}, 5e-3, 15e-3, {1e11}, 1, 0}});
    ProfileBarrier away = bridge(FlatCurve{});
    away.from = 0.01;
    const auto at = [](double rate, int modes) { return Settings{rate, 44100, modes, {}}; };
    const Settings usual{44100, 44100, 133, {}}, fast{352800, 352800, 80, {}};
    const std::string two_point = "modal_two_point", newton = "modal_spatial_newton",
                      matched = " compliance=matched";
    return {
        {two_point, free, {22050, 22050, 133, {}}, "not below half the sample rate"},
        {two_point, free, {44100, 48000, 10, {}}, "whole multiple"},
        {two_point + " form=dense", free, usual, "unknown option"},
        {two_point + matched + " points=8", with_loss(parabola, 1), {128e3, 128e3, 80, {}}, ""},
        {two_point + matched, inside, {64000, 64000, 40, {}}, "inside a rigid barrier"},
        {two_point + matched, beside, {64000, 64000, 40, {}}, "beside one that gives way"},
        {"modal_quadratised levels=4", c3, at(44100, 40), "expected one of"},
        {"modal_quadratised variant=relaxed", c3, at(44100, 40), "expected one of"},
        {"modal_quadratised", c3, at(44100, 200), "not below half the sample rate"},
        {"modal_quadratised" + matched, with_loss(two_bridges, 0.5), fast, ""},
        // at 44.1 kHz all 133 modes yield by 1.045 of what they should
        {"modal_quadratised levels=3" + matched, c3, usual, "yields more than the true one"},
        {"modal_three_point" + matched, c3, usual, "yields more than the true one"},
        {newton, parabola, at(44100, 20), "no node"},
        {newton, with_barriers(bridge_scene, {point, point}), at(44100, 1001), "node 6"},
        {newton + " gird=5", c3, usual, "unknown option"},
        {newton, c3, {44100, 48000, 133, {}}, "whole multiple"},
        {"finite_difference_explicit" + matched, with_loss(c3, 5), at(176400, 0), ""},
        {"finite_difference_theta" + matched, with_loss(c3, 5), at(176400, 0), ""},
        {"finite_difference_hamiltonian" + matched, with_loss(c3, 5), at(176400, 0), ""},
        {"finite_difference_theta points=0" + matched, parabola, at(88200, 0), ""},
        {"finite_difference_theta points=2.5" + matched, parabola, at(88200, 0), ""},
        {"finite_difference_theta points=257" + matched, parabola, at(88200, 0), ""},
        {"sitar_waveguide", with_string(sitar, [](String& s) { s.bending_stiffness = 1e-5; }),
         usual, "bending stiffness"},
        {"sitar_fdm stiffness=dispersion",
         with_string(sitar, [](String& s) { s.bending_stiffness = 1e-5; }), usual, "ignore"},
        {"sitar_waveguide stiffness=dispersion",
         with_string(sitar, [](String& s) { s.bending_stiffness = 1e-5; }), usual,
         "length=fractional"},
        {"sitar_waveguide", with_barriers(sitar, {away}), usual, "x = 0"},
        {"sitar_fdm", with_barriers(sitar, {bridge(FlatCurve{}, 0.002)}), usual,
         "shorter than one cell"},
        {"sitar_fdm",
         with_string(with_barriers(sitar, {bridge(FlatCurve{})}),
                     [](String& s) {
                         s.start = TriangleShape{0.11, -2e-3, 0};
                     }),
         usual, "below the bridge"},
        {"sitar_waveguide",
         with_string(sitar,
                     [](String& s) {
                         s.start = ModeShape{43, 1e-3};
                     }),
         usual, "half the sample rate"},
        {"exact_contact tolerance=0", c3, at(0, 5), ""},
        {"exact_contact tolerance=1", c3, at(0, 5), ""},
        {"exact_contact compliance=own", rigid_bridge, at(0, 40), "compliance=matched"},
        {"exact_contact" + matched, flat, at(0, 20), ""},
        {"sundials" + matched, flat, at(0, 20), ""},
        {"sundials" + matched, c3_pluck(), at(0, 20), ""},
        {"sundials method=euler", c3, at(0, 10),
         "option method: found \"euler\", expected one of bdf, adams"},
        {"sundials rtol=2", c3, at(0, 10), "option rtol: expected a tolerance between 0 and 1"},
        {"sundials atol=1", c3, at(0, 10), "unknown option atol"},
    };
}

TEST(Refusals, SayWhatAFormCannotDoWithAScene) {
    for (const Refused& r : refused()) {
        const std::string message = refusal(r.form, r.scene, r.settings);
        EXPECT_NE(message, "") << r.form << " takes " << r.scene.name;
        EXPECT_TRUE(says(message, r.why)) << r.form << " on " << r.scene.name;
    }
    EXPECT_EQ(refusal("exact_contact compliance=matched", c3_pluck(), {0, 44100, 20, {}}), "");
}

TEST(Refusals, AreOfMatchedComplianceByEachPenalty) {
    std::vector<std::string> penalties{"modal_explicit_penalty"};
    for (const Descriptor& d : schemes_of_pairings())
        if (std::string(d.name).ends_with("_penalty")) penalties.emplace_back(d.name);
    EXPECT_EQ(penalties.size(), 6u);
    for (const std::string& form : penalties)
        EXPECT_NE(refusal(form + " compliance=matched", c3_release(), {88200, 44100, 40, {}}), "")
            << form;
}

TEST(Refusals, AreNoneWhereStiffnessIsIgnoredOrTheRateIsHighEnough) {
    Scene stiff = sitar_scene();
    stiff.strings[0].bending_stiffness = 1e-5;
    EXPECT_EQ(fact(run_sitar("sitar_fdm stiffness=ignore", stiff), "ignored_bending_stiffness"),
              1e-5);
    const auto r = play("modal_quadratised levels=3 compliance=matched",
                        lasting(c3_release(), 1e-3), {8 * 44100, 44100, 133, {}});
    EXPECT_GT(fact(r, "series_compliance"), 0);
}

}  // namespace
}  // namespace jvari
