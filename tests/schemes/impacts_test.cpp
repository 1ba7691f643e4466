// What a run tells of its contacts: against the closed form of an oscillator that meets a spring,
// against the energy columns, and against the rows of the contact force.
#include "schemes/impacts.hpp"

#include <numbers>

#include "scenes/scene_file.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

using std::numbers::pi;
const Settings audio{44100, 44100, 0, {}};

struct Told {
    Run run;
    std::vector<Impacts> impacts;
};
Told play_with_impacts(const std::string& form, const Scene& scene, const Settings& settings,
                       bool energy = true) {
    Told t{{}, {scene.strings.begin(), scene.strings.end()}};
    RunOptions how;
    how.energy = energy;
    how.impacts = t.impacts.data();
    t.run = play(form, scene, settings, how);
    return t;
}

// The first mode of a string has half its mass: 100 kg and 10 rad/s, 1e4 N/m, which leaves 0.1 m at
// rest and passes 0 at 1 m/s, where a stop of 1e6 N/m stands.
Scene oscillator(double beta = 0) {
    Scene scene;
    scene.name = "oscillator";
    scene.duration = 0.25;
    String s;
    s.length = 1;
    s.linear_density = 200;
    s.tension = s.linear_density * std::pow(10 / pi, 2);
    s.start = ModeShape{1, 0.1};
    s.barriers = {LumpedBarrier{0.5, 0, 0, {1e6}, 1, beta}};
    scene.strings = {s};
    scene.taps = {{"stop", Quantity::bridge_force, 0, 0}};
    return scene;
}

TEST(Impacts, OfAnOscillatorAgainstASpringHaveTheirClosedForm) {
    // in contact m y'' = -(k + K) y: half a period, the depth v/omega, the impulse K 2 v/omega^2
    const double omega = std::sqrt(1.01e6 / 100), start = 0.5 * pi / 10, end = start + pi / omega,
                 largest = 1e6 / omega, impulse = 2e6 / (omega * omega);
    EXPECT_NEAR(largest, 9950.371902, 1e-6);
    EXPECT_NEAR(impulse, 198.019802, 1e-6);
    Settings one = audio;
    one.modes = 1;
    const double dt = 1 / one.sample_rate, step = std::pow(omega * dt, 2);
    for (const auto& [form, instant, value] : {std::tuple{"exact_contact", 1e-12, 1e-9},
                                               {"modal_two_point", dt, step},
                                               {"modal_three_point", dt, step}}) {
        const Told t = play_with_impacts(form, oscillator(), one);
        ASSERT_TRUE(t.impacts[0].reported) << form;
        ASSERT_EQ(t.impacts[0].all().size(), 1u) << form;
        const Impact& i = t.impacts[0].all()[0];
        EXPECT_NEAR(i.start, start, instant) << form;
        EXPECT_NEAR(i.end, end, instant) << form;
        EXPECT_NEAR(i.largest_force, largest, value * largest) << form;
        // the last step of a scheme is cut by its end
        EXPECT_NEAR(i.impulse, impulse, value * impulse) << form;
        EXPECT_NEAR(i.speed_in, 1, 1e-9 + 20 * dt * (instant > 1e-9)) << form;
        EXPECT_NEAR(i.speed_out, 1, 1e-9 + 20 * dt * (instant > 1e-9)) << form;
        EXPECT_NEAR(i.energy_lost, 0, 1e-11 * 50) << form;
    }
}

// It begins 1 mm deep in the stop, at rest: 0.5 J that it gives back are no loss.
TEST(Impacts, ThatBeginBeforeTheRunLoseNoneOfWhatTheyHadStored) {
    Scene scene = oscillator();
    scene.duration = 0.05;
    scene.strings[0].start = ModeShape{1, -1e-3};
    Settings one = audio;
    one.modes = 1;
    for (const char* form : {"exact_contact", "modal_two_point", "modal_three_point"}) {
        const Told t = play_with_impacts(form, scene, one);
        ASSERT_GE(t.impacts[0].all().size(), 1u) << form;
        const Impact& i = t.impacts[0].all()[0];
        EXPECT_LT(i.start, 1e-4) << form;
        EXPECT_LT(i.end, 0.04) << form;
        EXPECT_NEAR(i.energy_lost, 0, 1e-11) << form;
    }
}

TEST(Impacts, LoseWhatTheEnergyColumnsSay) {
    Settings one = audio;
    one.modes = 1;
    double by_exact = 0;
    for (const char* form : {"exact_contact", "modal_two_point", "modal_three_point"}) {
        const Told t = play_with_impacts(form, oscillator(0.3), one);
        double dissipated = 0;
        for (const double x : t.run.trace.energy_column(2)) dissipated += x;
        ASSERT_EQ(t.impacts[0].all().size(), 1u) << form;
        const Impact& i = t.impacts[0].all()[0];
        EXPECT_GT(i.energy_lost, 5) << form;
        EXPECT_NEAR(i.energy_lost, dissipated, 1e-11 * dissipated) << form;
        EXPECT_NEAR(i.energy_lost, 50 * (1 - i.speed_out * i.speed_out), 0.03) << form;
        if (by_exact == 0) by_exact = i.energy_lost;
        EXPECT_NEAR(i.energy_lost, by_exact, 1e-3 * by_exact) << form;
    }
}

const char* const with_a_state[] = {"exact_contact",     "modal_two_point",
                                    "modal_three_point", "modal_two_point compliance=matched",
                                    "modal_quadratised", "modal_quadratised levels=3"};

// 0.02 m inside the spring, which throws it out; and within the contact at 0.157 .. 0.188 s
TEST(Impacts, ThatAreOnAtTheStartOrAtTheEndLoseWhatTheirLossTakesAndNoMore) {
    Settings one = audio;
    one.modes = 1;
    Scene inside = lasting(oscillator(), 0.1), open = lasting(oscillator(), 0.17);
    inside.strings[0].start = ModeShape{1, -0.02};
    for (const char* form : with_a_state) {
        const Told first = play_with_impacts(form, inside, one),
                   last = play_with_impacts(form, open, one);
        ASSERT_EQ(first.impacts[0].all().size(), 1u) << form;
        ASSERT_EQ(last.impacts[0].all().size(), 1u) << form;
        const Impact &from = first.impacts[0].all()[0], &to = last.impacts[0].all()[0];
        EXPECT_NEAR(from.energy_lost, 0, 1e-9 * 200) << form;
        EXPECT_NEAR(to.energy_lost, 0, 1e-9 * 50) << form;
        EXPECT_TRUE(std::isnan(from.speed_in)) << form << from.speed_in;
        if (form != std::string("modal_two_point compliance=matched")) {  // of more modes
            EXPECT_NEAR(from.speed_out, 2, 0.02) << form;
        }
    }
    inside.strings[0].barriers = {LumpedBarrier{0.5, 0, 0, {1e6}, 1, 0.1}};
    double by_exact = 0;
    for (const char* form :
         {"exact_contact", "modal_two_point", "modal_three_point", "modal_quadratised levels=3"}) {
        const Told t = play_with_impacts(form, inside, one);
        const double lost = t.impacts[0].all().at(0).energy_lost;
        if (by_exact == 0) by_exact = lost;
        EXPECT_GT(lost, 1) << form;
        EXPECT_NEAR(lost, by_exact, 1e-3 * by_exact) << form;
    }
}

TEST(Impacts, ComeInTowardsTheBarrierAndGoOutAwayFromItOrAreNotSeen) {
    const Scene scene = lasting(read_scene("tanpura_c3_release"), 0.05);
    for (const char* form :
         {"exact_contact", "modal_two_point", "modal_two_point compliance=matched",
          "modal_three_point", "finite_difference_theta"}) {
        int seen = 0;
        const Told t = play_with_impacts(form, scene, audio, false);
        for (const Impact& i : t.impacts[0].all()) {
            EXPECT_FALSE(i.speed_in < 0) << form << ' ' << i.start;
            EXPECT_FALSE(i.speed_out < 0) << form << ' ' << i.end;
            seen += i.speed_in > 0 && i.speed_out > 0;
        }
        EXPECT_GT(seen, 5) << form;
    }
}

// With a thread, several points, what is in series, several strings, and a body that moves.
TEST(Impacts, PushAsMuchAsTheRowsOfTheContactForce) {
    struct Case {
        const char *form, *scene;
        int modes;
    };
    for (const auto& [form, name, modes] :
         {Case{"modal_two_point", "tanpura_c3_release", 60},
          {"modal_two_moment", "tanpura_c3_release", 60},
          {"modal_two_moment compliance=matched", "two_point_bridge", 60},
          {"exact_contact", "tanpura_c3_release", 60},
          {"modal_two_point compliance=matched", "tanpura_c3_release", 60},
          {"modal_two_point", "sitar_parabola", 60},
          {"exact_contact nodes=6", "sitar_parabola", 40},
          {"finite_difference_theta", "tanpura_c3_release", 100},
          {"modal_two_point", "sitar_sympathetic", 40}}) {
        Scene scene = lasting(read_scene(name), 0.03);
        scene.taps.clear();
        for (int k = 0; k < static_cast<int>(scene.strings.size()); ++k)
            if (!scene.strings[k].barriers.empty())
                scene.taps.push_back({"push" + std::to_string(k), Quantity::bridge_force, k, 0});
        Settings settings = audio;
        settings.modes = modes;
        const Told t = play_with_impacts(form, scene, settings);
        ASSERT_EQ(t.run.status.outcome, Outcome::ok) << form << name;
        int contacts = 0;
        for (std::size_t k = 0; k < scene.taps.size(); ++k) {
            const Impacts& of = t.impacts[static_cast<std::size_t>(*scene.taps[k].string)];
            double rows = 0, impulses = 0, hardest = 0;
            for (const double f : t.run.trace.column(static_cast<int>(k))) rows += f / 44100;
            for (const Impact& i : of.all()) {
                // what the step behind the last row does is in no row
                if (i.end > scene.duration - 1e-9) continue;
                impulses += i.impulse;
                hardest = std::max(hardest, i.largest_force);
                EXPECT_LT(i.start, i.end) << form << name;
                ++contacts;
            }
            const bool ends_open = !of.all().empty() && of.all().back().end > scene.duration - 1e-9;
            if (ends_open) continue;
            EXPECT_NEAR(impulses, rows, 1e-9 * std::abs(rows)) << form << name << k;
            for (const double f : t.run.trace.column(static_cast<int>(k)))
                EXPECT_LE(f, hardest * (1 + 1e-9)) << form << name << k;
        }
        EXPECT_GT(contacts, 1) << form << name;
    }
}

// The force on a rigid bridge jumps within 1 us to four times the largest row. The exact solution
// finds this peak for rows, and so windows, of any length.
TEST(Impacts, OfARigidBridgeHaveTheSameLargestForceWhateverTheRows) {
    const Scene scene = lasting(read_scene("rigid_point_bridge"), 2e-3);
    const auto largest = [&](int times) {
        Settings settings = audio;
        settings.modes = 40;
        settings.tap_rate *= times;
        const Told t = play_with_impacts("exact_contact", scene, settings, false);
        double hardest = 0;
        for (const Impact& i : t.impacts[0].all()) hardest = std::max(hardest, i.largest_force);
        const double most = fact(t.run, "largest_contact_force");
        EXPECT_NEAR(hardest, most, 1e-9 * most) << times;
        for (const double f : t.run.trace.column(3)) EXPECT_LE(f, most) << times;
        return most;
    };
    const double most = largest(1);
    EXPECT_NEAR(most, 3.19, 0.01);
    for (const int times : {4, 64}) EXPECT_NEAR(largest(times), most, 1e-9 * most) << times;
}

TEST(Impacts, NameTheBarrierThatIsTouched) {
    Scene scene = oscillator();
    scene.strings[0].barriers.insert(scene.strings[0].barriers.begin(),
                                     LumpedBarrier{0.25, 0, -0.5, {1e6}, 1, 0});
    Settings one = audio;
    one.modes = 1;
    for (const char* form : {"exact_contact", "modal_two_point"}) {
        const Told t = play_with_impacts(form, scene, one);
        ASSERT_EQ(t.impacts[0].all().size(), 1u) << form;
        EXPECT_EQ(t.impacts[0].all()[0].barrier, 1) << form;
    }
}

TEST(Impacts, NameTheProfileWhosePointIsTouched) {
    Scene scene = oscillator();
    LumpedBarrier far{0.7, 0, -0.5, {1e6}, 1, 0};
    scene.strings[0].barriers = {far, ProfileBarrier{FlatCurve{}, 0.4, 0.6, {1e6}, 1, 0}, far};
    Settings one = audio;
    one.modes = 1;
    for (const char* form : {"exact_contact nodes=3", "modal_two_point points=3",
                             "modal_generalised_alpha points=3"}) {
        const Told t = play_with_impacts(form, scene, one);
        EXPECT_EQ(t.impacts[0].all().size(), 1u) << form;
        for (const Impact& i : t.impacts[0].all()) EXPECT_EQ(i.barrier, 1) << form;
    }
}

TEST(Impacts, AreToldBesideTheSameRows) {
    for (const char* form :
         {"modal_two_point", "modal_two_point compliance=matched", "exact_contact"}) {
        const Scene scene = lasting(read_scene("tanpura_c3_release"), 0.02);
        const auto bare = play(form, scene, audio);
        const Told t = play_with_impacts(form, scene, audio, false);
        EXPECT_GT(t.impacts[0].all().size(), 2u) << form;
        EXPECT_EQ(bare.trace.tap, t.run.trace.tap) << form;
        EXPECT_EQ(fact(bare, "largest_contact_force"), fact(t.run, "largest_contact_force"));
    }
}

}  // namespace
}  // namespace jvari
