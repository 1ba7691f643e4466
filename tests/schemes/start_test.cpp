// Where a string begins: in equilibrium, with a velocity, from the state of another run; and forces
// that come from a file. All schemes and references by the same closed forms.
#include "scenes/start.hpp"

#include <numbers>

#include "bench/check/allocations.hpp"
#include "scenes/columns.hpp"
#include "scenes/excitation.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

const Settings usual{44100, 44100, 40, {}};

std::vector<std::string> forms_for(const Scene& scene, bool with_matched) {
    std::vector<std::string> forms;
    for (const auto& table : {schemes(), references(), std::span(schemes_of_pairings())})
        for (const Descriptor& d : table) {
            if (!represents(d, scene)) continue;
            forms.emplace_back(d.name);
            if (with_matched && declares(d, "compliance"))
                forms.push_back(d.name + std::string(" compliance=matched"));
        }
    return forms;
}

bool has(const std::vector<std::string>& forms, const std::string& form) {
    return std::find(forms.begin(), forms.end(), form) != forms.end();
}

// ---- In equilibrium

Scene lifted(double height, double k) {  // by a bridge 10 mm from its end
    Scene scene = lasting(c3_free(), 0.02);
    String& s = scene.strings.front();
    s.start = RestStart{};
    s.barriers = {LumpedBarrier{10e-3, 2e-3, height, {k}, 1, 0}};
    scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});

    return scene;
}

// Displacement and nut force stay what they are, and the bridge pushes as it does.
void expect_at_rest(const std::string& form, const Scene& scene, double height, double force) {
    SCOPED_TRACE(form);
    const jvari::Run r = play(form, scene, usual);
    ASSERT_EQ(r.status.outcome, Outcome::ok);
    for (int k = 0; k < 2; ++k) {
        const auto column = r.trace.column(k);
        const double scale = k == 0 ? scene.strings.front().tension * height : height;
        for (const double y : column) ASSERT_NEAR(y, column[0], 1e-12 * scale);
        EXPECT_GT(std::abs(column[0]), 0.1 * scale);
    }

    for (const double F : r.trace.column(2).subspan(1)) ASSERT_NEAR(F, force, 1e-12 * force);
}

// By which the bridge's point yields per newton: the true string's where matched, else that of its
// modes, times what the scheme says of its steps.
double compliance_of(const std::string& form, const Scene& scene) {
    const String& s = scene.strings.front();
    const auto& b = std::get<LumpedBarrier>(s.barriers.front());
    const Footprint at{b.position, b.width};
    if (form.find("matched") != std::string::npos) return static_deflection(s, at, at);
    const Modes m = modes_of(s, usual.modes);
    double c = static_compliance(m, footprint_weights(m, at.position, at.width));
    Settings settings = usual;
    const Descriptor& d = with_options(form, settings);
    for (const Fact& f : make_scheme(d, scene, settings)->facts())
        if (f.name == facts::static_compliance.name) c *= f.value;
    return c;
}

TEST(Equilibrium, OfEverySchemeStaysAndItsForceIsKhOver1PlusKC) {
    const double h = 1e-3, k = 1e4;
    const Scene scene = lifted(h, k);
    EXPECT_GT(compliance_of("modal_two_point compliance=matched", scene),
              1.1 * compliance_of("exact_contact", scene));
    const auto forms = forms_for(scene, true);
    for (const char* form :
         {"modal_two_point", "modal_two_point compliance=matched", "modal_three_point",
          "modal_three_point compliance=matched", "modal_quadratised", "modal_explicit_penalty",
          "modal_generalised_alpha compliance=matched", "exact_contact", "sundials",
          "exact_contact compliance=matched", "sundials compliance=matched"})
        EXPECT_TRUE(has(forms, form)) << form;
    for (const char* form : {"finite_difference_theta", "modal_tension", "modal_moreau_jean"})
        EXPECT_FALSE(has(forms, form)) << form;
    for (const std::string& form : forms)
        expect_at_rest(form, scene, h, k * h / (1 + k * compliance_of(form, scene)));
    for (const char* form : {"modal_quadratised levels=3 compliance=matched",
                             "modal_quadratised variant=raw levels=3"})
        expect_at_rest(form, scene, h, k * h / (1 + k * compliance_of(form, scene)));
}

// Threads, a power law, contact loss, a contact that stays open and a steady force do not move it
// either.
TEST(Equilibrium, StaysUnderAllThatPresses) {
    Scene scene = lifted(1e-3, 1e4);
    String& s = scene.strings.front();
    s.thread = Thread{5e-3, 1.2e-3, 1.2e3, 0.1, -1e-3};
    s.pluck = Pluck{};
    force_from("f.csv", "time_s,force_N\n0,0.3\n0.015,0.3\n1,0.3\n", *s.pluck);
    s.pluck->position = 0.4;
    std::get<LumpedBarrier>(s.barriers.front()).contact_loss = 0.5;
    for (const std::string form :
         {"modal_two_point", "modal_three_point", "modal_quadratised", "modal_explicit_penalty",
          "exact_contact", "sundials", "modal_quadratised levels=3", "modal_generalised_alpha"}) {
        SCOPED_TRACE(form);
        const jvari::Run r = play(form, scene, usual);
        const auto y = r.trace.column(1), F = r.trace.column(2);
        for (const double x : y) ASSERT_NEAR(x, y[0], 1e-15);
        for (const double x : F.subspan(1)) ASSERT_NEAR(x, F[1], 1e-12 * F[1]);
        EXPECT_GT(F[1], 1);
    }
    std::get<LumpedBarrier>(s.barriers.front()).contact_loss = 0;
    for (const std::string form : {"modal_two_point", "modal_three_point", "modal_quadratised",
                                   "modal_quadratised levels=3", "exact_contact"}) {
        SCOPED_TRACE(form);
        const jvari::Run r = play(form + " compliance=matched", scene, usual);
        const auto nut = r.trace.column(0), y = r.trace.column(1), F = r.trace.column(2);
        for (const double x : nut) ASSERT_NEAR(x, nut[0], 1e-13);
        for (const double x : y) ASSERT_NEAR(x, y[0], 1e-15);
        for (const double x : F.subspan(1)) ASSERT_NEAR(x, F[1], 1e-12 * F[1]);
    }
    s.barriers.push_back(LumpedBarrier{0.1, 0, 5e-3, {1e5}, 1.5, 0});
    s.barriers.push_back(LumpedBarrier{0.5, 0, 0, {1e5}, 1, 0});
    // whose equilibrium in a power law is unstable: 2 to 40 % after 20 ms on a stiff bridge
    for (const char* form : {"modal_quadratised", "modal_quadratised levels=3",
                             "modal_quadratised compliance=matched"})
        EXPECT_TRUE(says(refusal(form, scene, usual), "does not stay at rest on a contact"))
            << form;
    for (const std::string form :
         {"modal_two_point", "modal_three_point", "exact_contact", "sundials"}) {
        SCOPED_TRACE(form);
        const jvari::Run r = play(form, scene, usual);
        const auto y = r.trace.column(1), F = r.trace.column(2);
        for (const double x : y) ASSERT_NEAR(x, y[0], 1e-14);
        for (const double x : F.subspan(1)) ASSERT_NEAR(x, F[1], 1e-11 * F[1]);
    }
}

TEST(Equilibrium, OverARigidBridgeIsItsHeight) {
    Scene scene = lifted(1e-3, rigid);
    std::get<LumpedBarrier>(scene.strings[0].barriers[0]).width = 0;
    scene.taps.push_back({"y_b", Quantity::displacement, 0, 10e-3});
    std::get<LumpedBarrier>(scene.strings.front().barriers.front()).width = 0;
    for (const char* form : {"modal_two_point", "modal_two_point compliance=matched",
                             "modal_three_point", "modal_three_point compliance=matched"})
        expect_at_rest(form, scene, 1e-3, 1e-3 / compliance_of(form, scene));
    EXPECT_NEAR(play("modal_two_point", scene, usual).trace.column(3)[700], 1e-3, 1e-15);
}

// ---- With a velocity

// y = v sin(wt) e^-st/w of the first mode, w and s those of the string.
double error_of_velocity(const std::string& form, double rate, bool from_a_file) {
    Scene scene = lasting(c3_free(), 0.02);
    String& s = scene.strings.front();
    s.damping = PolynomialDamping{20, 0, 0};
    scene.taps = {{"y", Quantity::displacement, 0, 0.3}, {"v", Quantity::velocity, 0, 0.3}};
    constexpr double v = 1.5;
    if (from_a_file) s.start = start_from("t.csv", "mode,displacement,velocity\n1,0,1.5\n");
    else s.velocity = ModeShape{1, v};
    const jvari::Run r = play(form, scene, {rate, 44100, 20, {}});
    const Modes m = modes_of(s, 1);
    const double w = std::sqrt(omega_squared_damped(m.omega0[0], m.sigma[0])),
                 at = std::sin(0.3 * std::numbers::pi);
    EXPECT_NEAR(r.trace.column(1)[0], v * at, 1e-8) << form;
    std::vector<double> y;
    for (long n = 0; n < r.trace.rows; ++n) {
        const double t = static_cast<double>(n) / 44100;
        y.push_back(v * at * std::exp(-m.sigma[0] * t) * std::sin(w * t) / w);
    }
    return relative_difference(r.trace.column(0), y);
}

TEST(InitialVelocity, ConvergesByTheOrderOfEverySchemeThatTakesIt) {
    Scene scene = c3_free();
    scene.strings.front().velocity = ModeShape{1, 1};
    const auto forms = forms_for(scene, false);
    for (const char* form : {"modal_two_point", "modal_tension", "finite_difference_explicit",
                             "finite_difference_theta", "finite_difference_hamiltonian",
                             "modal_generalised_alpha", "exact_linear", "modal_spatial_newton"})
        EXPECT_TRUE(has(forms, form)) << form;
    EXPECT_FALSE(has(forms, "sitar_fdm"));
    EXPECT_TRUE(says(refusal("sitar_fdm stiffness=ignore", scene, {44100, 44100, 0, {}}),
                     "initial velocity"));
    for (const std::string& form : forms) {
        const double once = error_of_velocity(form, 44100, false),
                     twice = error_of_velocity(form, 88200, true);
        // a grid at its limit gets finer by whole intervals
        const double falls = form.starts_with("finite_difference_explicit") ? 2 : 3;
        EXPECT_LT(once, 5e-4) << form;
        EXPECT_TRUE(twice < 1e-9 || twice < once / falls) << form << ": " << once << ", " << twice;
    }
}

// The same with contacts, where references agree, and of strings whose ends move or that stretch.
TEST(InitialVelocity, OverABridgeAndOnABodyTendsToTheReference) {
    const auto thrown = [](Scene scene) {
        scene = lasting(scene, 0.01);
        scene.strings.front().start.reset();
        scene.strings.front().velocity = TriangleShape{0.4, -2, 0.2};
        return scene;
    };
    Scene bridge = c3_release();
    barrier(bridge).stiffness.k = 1e5;
    bridge = thrown(bridge);
    const Settings continuous{0, 44100, 20, {}};
    const jvari::Run exact = play("exact_contact", bridge, continuous);
    EXPECT_LT(apart(play("sundials", bridge, continuous), exact, 1), 1e-8);
    Scene body = bridge;
    body.body = Body{"", "", {{0.02, 2.5e4, 0.5}, {0.05, 2e5, 2}}};
    Scene stretching = thrown(c3_free());
    stretching.strings.front().axial_stiffness = 2e4;
    const jvari::Run moved = play("sundials", body, continuous),
                     stretched = play("sundials", stretching, continuous);
    struct Trial {
        const char* form;
        const Scene& scene;
        const jvari::Run& truth;
    };
    for (const Trial& t :
         std::initializer_list<Trial>{{"modal_two_point", bridge, exact},
                                      {"modal_three_point", bridge, exact},
                                      {"modal_quadratised", bridge, exact},
                                      {"modal_quadratised levels=3", bridge, exact},
                                      {"modal_two_point", body, moved},
                                      {"modal_spatial_newton", body, moved},
                                      {"modal_tension", stretching, stretched}}) {
        const double once = apart(play(t.form, t.scene, {88200, 44100, 20, {}}), t.truth, 1),
                     twice = apart(play(t.form, t.scene, {352800, 44100, 20, {}}), t.truth, 1);
        EXPECT_LT(once, 0.05) << t.form;
        // psi by gamma of the older level is of first order
        const double falls = t.form == std::string("modal_quadratised") ? 3.5 : 6;
        EXPECT_LT(twice, once / falls) << t.form << ": " << once << ", " << twice;
    }
}

// ---- From the state of another run

TEST(State, TwoRunsJoinedAreOne) {
    Scene scene = c3_release();
    barrier(scene).stiffness.k = 1e5;
    scene.strings.front().thread->stiffness = 1e4;
    RunOptions keep;
    keep.state = true;
    int continued = 0;
    const auto forms = forms_for(scene, true);
    for (const std::string& form : forms) {
        SCOPED_TRACE(form);
        const jvari::Run whole = play(form, lasting(scene, 0.02), usual),
                         first = play(form, lasting(scene, 0.01), usual, keep);
        if (first.state.displacement.empty()) continue;
        ++continued;
        Scene after = lasting(scene, 0.01);
        TableStart start{"", "", true, {}, first.state.displacement, first.state.velocity};
        for (std::size_t i = 0; i < start.displacement.size(); ++i)
            start.at.push_back(static_cast<double>(i + 1));
        after.strings.front().start = start;
        const jvari::Run second = play(form, after, usual);
        const long rows = second.trace.rows, from = first.trace.rows - 1;
        ASSERT_EQ(from + rows, whole.trace.rows);
        for (int k = 0; k < whole.trace.taps(); ++k) {
            const auto column = whole.trace.column(k);
            EXPECT_EQ(largest_difference(first.trace.column(k), column.first(from + 1)), 0);
            const auto joined = column.subspan(from);
            // contact forces are means since the row before
            const long skip = scene.taps[k].quantity == Quantity::bridge_force ||
                              scene.taps[k].quantity == Quantity::thread_force;
            // an integrator begins anew, within its tolerance
            const double to = form.starts_with("sundials") ? 1e-11 : 1e-12;
            EXPECT_LT(
                largest_difference(second.trace.column(k).subspan(skip), joined.subspan(skip)),
                to * largest(column))
                << whole.trace.names[k];
        }
    }
    for (const char* form : {"modal_two_point", "exact_contact", "sundials"})
        EXPECT_TRUE(has(forms, form)) << form;
    EXPECT_GE(continued, 5);
    const auto keeps = [&](const std::string& form) {
        return !play(form, lasting(scene, 0.001), usual, keep).state.displacement.empty();
    };
    EXPECT_TRUE(keeps("modal_two_point"));
    EXPECT_TRUE(keeps("exact_contact"));
    for (const char* form : {"modal_two_point compliance=matched", "modal_quadratised",
                             "modal_three_point", "exact_contact compliance=matched"})
        EXPECT_FALSE(keeps(form)) << form;
}

// ---- From where another scheme stands

std::unique_ptr<Scheme> maker(const std::string& form, const Scene& scene, int modes = 133) {
    Settings settings{44100, 44100, modes, {}};
    const Descriptor& d = with_options(form, settings);
    return make_scheme(d, scene, settings);
}
std::vector<std::vector<double>> rows_of(Scheme& scheme, const Scene& scene, int rows) {
    std::vector<double> taps(scene.taps.size() * static_cast<std::size_t>(rows));
    const Block out{
        .rows = rows, .taps = int(scene.taps.size()), .stride = rows, .tap = taps.data()};
    EXPECT_EQ(scheme.advance(out).outcome, Outcome::ok);
    std::vector<std::vector<double>> columns;
    for (std::size_t k = 0; k < scene.taps.size(); ++k)
        columns.emplace_back(taps.begin() + long(k) * rows, taps.begin() + long(k + 1) * rows);
    return columns;
}

TEST(StartFrom, AStringThatSoundsGoesOnInASchemeOfItsOwn) {
    const Scene scene = c3_release();
    Scene tuned = scene;  // and plucked
    tuned.strings.front().tension *= 1.1;
    tuned.strings.front().pluck = c3_pluck().strings.front().pluck;
    for (const std::string form : {"modal_two_point", "modal_two_point compliance=matched"}) {
        SCOPED_TRACE(form);
        const bool matched = form.ends_with("matched");
        const auto sounding = maker(form, scene), same = maker(form, scene),
                   other = maker(form, tuned);
        rows_of(*sounding, scene, 300);
        bool taken = true;
        {
            const bench::check::Allocations allocations;
            taken = same->start_from(*sounding) && other->start_from(*sounding);
            EXPECT_EQ(allocations.count(), 0);
        }
        ASSERT_TRUE(taken);
        const auto on = rows_of(*sounding, scene, 300), joined = rows_of(*same, scene, 300),
                   retuned = rows_of(*other, tuned, 300);
        for (std::size_t k = 0; k < scene.taps.size(); ++k) {
            const std::span all(on[k]);
            // contact forces are means since the row before
            EXPECT_LT(largest_difference(std::span(joined[k]).subspan(1), all.subspan(1)),
                      1e-11 * largest(all))
                << scene.taps[k].name;
            if (scene.taps[k].quantity != Quantity::displacement) continue;
            // what is in series keeps its forces, and yields by them as the new string does
            EXPECT_NEAR(retuned[k][0], on[k][0], (matched ? 1e-5 : 1e-12) * largest(all));
            EXPECT_GT(std::abs(retuned[k][299] - on[k][299]), 1e-3 * largest(all));
        }
    }
    const auto sounding = maker("modal_two_point", scene);
    for (const std::string form : {"modal_three_point", "modal_two_point compliance=matched"})
        EXPECT_FALSE(maker(form, scene)->start_from(*sounding)) << form;
    EXPECT_FALSE(maker("modal_two_point", scene, 100)->start_from(*sounding));
    EXPECT_FALSE(maker("modal_two_point", c3_free())->start_from(*sounding));
}

// ---- Forces from a file

// m q'' + m w^2 q = g F of one mode, under F = a + b t:  q = g/(m w^2) [a (1 - cos wt) + b (t -
// sin(wt)/w)]
TEST(ForceOfAFile, ConstantAndRampMoveAFreeModeAsTheClosedFormSays) {
    Scene scene = lossless(lasting(c3_free(), 0.02));
    String& s = scene.strings.front();
    s.pluck = Pluck{};
    // turns where no row is, and goes on as it came
    force_from("f.csv", "time_s,force_N\n0,0.3\n0.01234567,-0.1938268\n0.0200001,-0.500004\n",
               *s.pluck);
    s.pluck->position = 0.4;
    const Modes m = modes_of(s, 1);
    const double w = m.omega0[0], g = footprint_weights(m, 0.4, 0)[0],
                 at = std::sin(0.3 * std::numbers::pi);
    const auto truth = [&](long rows) {
        std::vector<double> y;
        for (long n = 0; n < rows; ++n) {
            const double t = static_cast<double>(n) / 44100;
            y.push_back(at * g / (m.mass * w * w) *
                        (0.3 * (1 - std::cos(w * t)) - 40 * (t - std::sin(w * t) / w)));
        }
        return y;
    };
    const auto error = [&](const std::string& form, double rate) {
        const jvari::Run r = play(form, scene, {rate, 44100, 1, {}});
        return relative_difference(r.trace.column(1), truth(r.trace.rows));
    };
    for (const char* form : {"exact_linear", "exact_contact"})
        EXPECT_LT(error(form, 0), 1e-12) << form;
    EXPECT_LT(error("sundials", 0), 1e-9);
    for (const char* form :
         {"modal_two_point", "modal_three_point", "modal_generalised_alpha rho=1"}) {
        const double once = error(form, 44100), twice = error(form, 88200);
        EXPECT_LT(once, 1e-3) << form;
        EXPECT_LT(twice, once / 3.5) << form;
    }
}

TEST(ForceOfAFile, ThatSamplesThePluckTendsToIt) {
    const auto sampled = [](Scene scene, int lines) {
        Pluck& p = *scene.strings.front().pluck;
        std::string text = "time_s,force_N\n";
        for (int n = 0; n <= lines; ++n) {
            const double t = p.start + p.duration * n / lines;
            std::ostringstream row;
            row.precision(17);
            row << t << "," << force(p, t) << "\n";
            text += row.str();
        }
        Pluck file;
        force_from("f.csv", text, file);
        file.position = p.position, file.width = p.width;
        p = file;
        return scene;
    };
    Scene free = lasting(c3_free(), 0.022), bridge = lasting(c3_pluck(), 0.022);
    free.strings.front().pluck = bridge.strings.front().pluck =
        Pluck{-0.4, 20e-3, 3.0, 1e-3, 0.5, 1};
    const Settings continuous{0, 44100, 20, {}};
    for (const auto& [form, scene] :
         {std::pair<std::string, Scene>{"exact_linear", free}, {"exact_contact", bridge}}) {
        const jvari::Run truth = play(form, scene, continuous);
        const double coarse = apart(play(form, sampled(scene, 50), continuous), truth, 1),
                     fine = apart(play(form, sampled(scene, 400), continuous), truth, 1);
        EXPECT_LT(coarse, 1e-2) << form;
        EXPECT_NEAR(coarse / fine, 64, 6) << form;
    }
    const jvari::Run exact = play("exact_contact", sampled(bridge, 50), continuous);
    EXPECT_LT(apart(play("sundials", sampled(bridge, 50), continuous), exact, 1), 1e-7);
    EXPECT_LT(
        apart(play("modal_two_point", sampled(bridge, 50), {352800, 44100, 20, {}}), exact, 1),
        1e-2);
    RunOptions energy;
    energy.energy = true;
    EXPECT_LT(ledger(play("exact_linear", sampled(free, 50), continuous, energy).trace).sum, 1e-12);
    EXPECT_LT(ledger(play("exact_contact", sampled(bridge, 50), continuous, energy).trace).sum,
              1e-9);
    EXPECT_LT(ledger(play("modal_two_point", sampled(bridge, 50), usual, energy).trace).sum, 1e-10);
}

}  // namespace
}  // namespace jvari
