// Profiles under the references: the rule that makes points of them, the scheme that shares those
// points, and closed forms of strings against long obstacles.
#include <numbers>

#include "reference/profile_points.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

using std::numbers::pi;

String ideal_string() {
    String s;
    s.length = 0.8;
    s.linear_density = 5e-4;
    s.tension = 32;
    return s;
}

double wave_speed(const String& s) { return std::sqrt(s.tension / s.linear_density); }

Scene scene_of(String s, double duration) {
    Scene scene;
    scene.name = "string";
    scene.duration = duration;
    scene.strings = {std::move(s)};
    scene.taps = {{"y03", Quantity::displacement, 0, 0.3 * scene.strings[0].length},
                  {"bridge", Quantity::bridge_force, 0, 0}};
    return scene;
}

// ---- The rule.

TEST(ProfilePoints, IntegrateAForceOverTheProfileWithSecondOrder) {
    String s = ideal_string();
    s.barriers = {ProfileBarrier{ParabolaCurve{0.5}, 0.1, 0.3, {1e6}, 1.5, 0}};
    const auto force = [&](int count) {  // on mode 3 of a string that lies at -0.1 x
        double sum = 0;
        for (const Barrier& barrier : with_points(s, 10, {count}).barriers) {
            const auto& b = std::get<LumpedBarrier>(barrier);
            sum += b.stiffness.k * std::pow(b.height + 0.5 * b.position, b.exponent) *
                   std::sin(3 * pi * b.position / s.length);
        }
        return sum;
    };
    const double exact = force(256) + (force(256) - force(128)) / 3;
    for (const int count : {8, 16, 32}) {
        const double order = std::log2((force(count) - exact) / (force(2 * count) - exact));
        EXPECT_NEAR(order, 2, 0.02) << count;
    }
}

TEST(ProfilePoints, OfTheGridLieOnItsNodesWithAnIntervalsWeightEach) {
    String s = ideal_string();
    s.barriers = {ProfileBarrier{LineCurve{-0.01}, 0, 0.24, {1e9}, 1.3, 2},
                  LumpedBarrier{0.5, 0, 0, {1e9}, 1, 0}};
    const String points = with_points(s, 9, {0});  // nodes at 0.08 m, 0.16 m, 0.24 m
    ASSERT_EQ(points.barriers.size(), 4u);
    for (int q = 0; q < 3; ++q) {
        const auto& b = std::get<LumpedBarrier>(points.barriers[q]);
        EXPECT_NEAR(b.position, 0.08 * (q + 1), 1e-15);
        EXPECT_NEAR(b.height, -0.01 * b.position, 1e-18);
        EXPECT_NEAR(b.stiffness.k, 1e9 * 0.08, 1e-3);
        EXPECT_EQ(b.exponent, 1.3);
        EXPECT_EQ(b.contact_loss, 2);
    }
    EXPECT_EQ(points.barriers[3], s.barriers[1]);
    s.barriers = {ProfileBarrier{FlatCurve{}, 0, 0.8, {1e9}, 1, 0}};
    EXPECT_EQ(with_points(s, 9, {0}).barriers.size(), 9u);  // neither end of the string
}

TEST(ProfilePoints, RefuseWhatComesToNoneOrTooMany) {
    String s = ideal_string();
    s.barriers = {ProfileBarrier{FlatCurve{}, 0, 0.05, {1e9}, 1, 0}};
    EXPECT_THROW(with_points(s, 9, {0}), Refusal);
    s.barriers.push_back(s.barriers[0]);
    EXPECT_THROW(with_points(s, 9, {most_points / 2 + 1}), Refusal);
    const auto reason = [&](const std::string& nodes) {
        return refusal("sundials nodes=" + nodes, scene_of(s, 1e-3), {0, 44100, 9, {}});
    };
    EXPECT_EQ(reason("257"), "option nodes: expected grid, or a whole number from 1 to 256");
    EXPECT_EQ(reason("0"), "option nodes: expected grid, or a whole number from 1 to 256");
    EXPECT_EQ(reason("200"),
              "the profiles come to 400 points of contact; the references take 256 at most");
    EXPECT_NE(reason("grid").find("no node of a grid of 9"), std::string::npos);
}

// ---- Two references, and a scheme on the same points.

TEST(ProfileReferences, AgreeOnALinearProfile) {
    String s = ideal_string();
    s.barriers = {ProfileBarrier{ParabolaCurve{0.02}, 0, 0.1, {1e8}, 1, 0}};
    s.start = TriangleShape{0.2, 3e-3, 0.05};
    const Scene scene = scene_of(s, 3e-3);
    const auto truth = play("exact_contact nodes=12", scene, {0, 44100, 30, {}}),
               r = play("sundials nodes=12", scene, {0, 44100, 30, {}});
    EXPECT_EQ(fact(truth, "contact_points"), 12);
    EXPECT_EQ(fact(r, "contact_points"), 12);
    EXPECT_GT(fact(truth, "events"), 100);
    EXPECT_EQ(fact(r, "events"), fact(truth, "events"));
    EXPECT_LT(apart(r, truth, 0), 1e-9);
    EXPECT_LT(apart(r, truth, 1), 1e-7);
}

// ---- Static wrap. An ideal string whose ends lie h below the top of the parabola g = h - c (x -
// L/2)^2, at rest. Where it is pressed in by eta, T y'' + K eta = 0 with y = g - eta gives eta =
// 2c/k^2 (1 - cosh k xi/cosh k a), k^2 = K/T, |xi| <= a; elsewhere it is straight, and both slopes
// agree at the edges: s = 2ca - (2c/k) tanh ka, s (L/2 - a) = h - c a^2. The force is 2Ts. Rigid
// limit: the tangent from the end, a = L/2 - sqrt(L^2/4 - h/c), F = 4Tca.
// Since s depends on a - 1/k up to k^-2, the edge comes to it like k^-1, the force like k^-2.

struct Wrap {
    double length = 0.8, tension = 32, h = 4e-3, c = 0.0625;  // [m], [N], [m], [1/m]
    double rigid() const { return 0.5 * length - std::sqrt(0.25 * length * length - h / c); }
    struct Edge {
        double a, slope;
    };
    Edge edge(double K) const {
        const double k = std::sqrt(K / tension);
        double low = 0, high = 0.5 * length, slope = 0;
        for (int i = 0; i < 100; ++i) {
            const double a = 0.5 * (low + high);
            slope = 2 * c * (a - std::tanh(k * a) / k);
            (slope * (0.5 * length - a) < h - c * a * a ? low : high) = a;
        }
        return {low, slope};
    }
    Scene scene(double K) const {
        String s = ideal_string();
        // the first mode's critical
        s.damping = PolynomialDamping{pi / length * wave_speed(s), 0, 0};
        TableCurve table;
        for (int i = 0; i <= 400; ++i) {
            const double xi = -0.2 + 1e-3 * i;
            table.x.push_back(0.5 * length + xi);
            table.height.push_back(h - c * xi * xi);
        }
        s.barriers = {ProfileBarrier{table, 0.5 * length - 0.2, 0.5 * length + 0.2, {K}, 1, 0}};
        s.start = ModeShape{1, 6e-3};
        Scene scene = scene_of(s, 40e-3);
        scene.taps = {{"bridge", Quantity::bridge_force, 0, 0}, {"nut", Quantity::nut_force, 0, 0}};
        for (int i = 0; i <= taps; ++i)
            scene.taps.push_back(
                {"y" + std::to_string(i), Quantity::displacement, 0, 0.5 * length + xi(i)});
        return scene;
    }
    static constexpr int taps = 160;
    static double xi(int i) { return 2.5e-3 * i - 0.2; }
    std::vector<double> edges(const Trace& trace) const {  // of what is pressed in, in the last row
        std::vector<double> at;
        double before = 0;
        for (int i = 0; i <= taps; ++i) {
            const double gap = trace.column(2 + i)[trace.rows - 1] - (h - c * xi(i) * xi(i));
            if (i > 0 && (gap < 0) != (before < 0))
                at.push_back(xi(i) - (xi(i) - xi(i - 1)) * gap / (gap - before));
            before = gap;
        }
        return at;
    }
};

TEST(StaticWrap, HasTheForceAndTheLengthOfItsClosedForm) {
    const Wrap wrap;
    constexpr int points = 32, modes = 50;
    std::vector<double> force, edge;  // distance from the rigid limit's
    for (const double K : {2e4, 8e4, 3.2e5}) {
        const auto closed = wrap.edge(K);
        for (const Descriptor* d : {&exact_contact, &sundials}) {
            if (d == &sundials && K > 2e4) continue;
            const auto r =
                run(*d, wrap.scene(K), {0, 1000, modes, {{"nodes", std::to_string(points)}}});
            const auto settled = r.trace.rows - 1;
            const double F = r.trace.column(0)[settled];
            EXPECT_NEAR(F, 2 * wrap.tension * closed.slope, 3e-4 * F) << d->name << " " << K;
            EXPECT_NEAR(r.trace.column(1)[settled], wrap.tension * closed.slope, 4e-4 * F)
                << d->name << " " << K;
            const auto edges = wrap.edges(r.trace);
            ASSERT_EQ(edges.size(), 2u) << d->name << " " << K;
            const double spacing = 0.4 / points;
            EXPECT_NEAR(edges[0], -closed.a, 0.1 * spacing) << d->name << " " << K;
            EXPECT_NEAR(edges[1], closed.a, 0.1 * spacing) << d->name << " " << K;
            if (d == &sundials) continue;
            force.push_back(1 - F / (4 * wrap.tension * wrap.c * wrap.rigid()));
            edge.push_back(edges[1] - wrap.rigid());
        }
    }
    for (int i = 0; i < 2; ++i) {  // K is four times as large
        EXPECT_NEAR(std::log2(force[i] / force[i + 1]), 2, 0.2);
        EXPECT_NEAR(std::log2(edge[i] / edge[i + 1]), 1, 0.1);
    }
}

// ---- The ideal string on a flat obstacle as long as itself.

// Released from its first mode over an obstacle at rest level, it meets all of it at once, and as
// its penetration has the shape of the mode as well, it stays in it: cos(omega t), then half cycles
// with sqrt(omega^2 + K/mu), then half cycles with omega.
TEST(FlatObstacle, ReflectsTheFirstModeAsItsClosedFormSays) {
    String s = ideal_string();
    const double A = 3e-3, omega = pi * wave_speed(s) / s.length;
    s.start = ModeShape{1, A};
    for (const double K : {1e5, 1e11}) {
        s.barriers = {ProfileBarrier{FlatCurve{}, 0, s.length, {K}, 1, 0}};
        const double stiff = std::sqrt(omega * omega + K / s.linear_density),
                     period = pi / omega + pi / stiff;
        for (const Descriptor* d : {&exact_contact, &sundials})
            for (const char* nodes : {"grid", "16", "40"}) {
                const auto r = run(*d, scene_of(s, 20e-3), {0, 44100, 15, {{"nodes", nodes}}});
                std::vector<double> want;
                for (long n = 0; n < r.trace.rows; ++n) {
                    const double since = std::fmod(n / 44100.0 + 0.5 * pi / omega, period);
                    want.push_back(std::sin(0.3 * pi) * A *
                                   (since < pi / omega
                                        ? std::sin(omega * since)
                                        : -omega / stiff * std::sin(stiff * (since - pi / omega))));
                }
                ASSERT_EQ(r.status.outcome, Outcome::ok) << d->name << " " << nodes << " " << K;
                EXPECT_LT(relative_difference(r.trace.column(0), want),
                          d == &exact_contact ? 1e-13 : 1e-9)
                    << d->name << " " << nodes << " " << K;
            }
    }
}

// Plucked to a triangle at the middle, height A, over an obstacle h below: the corner opens to a
// flat top that sinks with A 2c/L while its flanks rest (d'Alembert). All that moves lands at once
// at ct = L/2 (1 + h/A), is thrown back with the same speed, and so the motion runs backwards: it
// repeats itself after L/c (1 + h/A) (Cabannes 1984).
TEST(FlatObstacle, ThrowsAPluckedStringBackTheWayItCame) {
    String s = ideal_string();
    const double A = 3e-3, h = 1.2e-3, c = wave_speed(s), L = s.length,
                 period = L / c * (1 + h / A);
    s.start = TriangleShape{0.5 * L, A, 0};
    const auto triangle = [&](double x) {  // odd, 2L periodic
        x = std::remainder(x, 2 * L);
        return std::copysign(A * (1 - std::abs(2 * std::abs(x) / L - 1)), x);
    };
    double last = 0;
    // sqrt(K/mu)/omega_1: it stays pi/sqrt(K/mu) in the obstacle at each bounce
    for (const double ratio : {20, 40, 80}) {
        const double stiff = ratio * pi * c / L, K = s.linear_density * stiff * stiff;
        s.barriers = {ProfileBarrier{TableCurve{"", {0, L}, {-h, -h}}, 0, L, {K}, 1, 0}};
        const auto r =
            run(exact_contact, scene_of(s, 2 * period), {0, 44100, 47, {{"nodes", "grid"}}});
        std::vector<double> rigid, delayed;
        for (long n = 0; n < r.trace.rows; ++n) {
            const auto at = [&](double t) {
                return 0.5 * (triangle(0.3 * L + c * t) + triangle(0.3 * L - c * t));
            };
            const double t = n / r.trace.tap_rate, longer = period + pi / stiff,
                         since = std::fmod(t, longer);
            rigid.push_back(at(0.5 * period - std::abs(std::fmod(t, period) - 0.5 * period)));
            delayed.push_back(at(std::min({since, 0.5 * period, longer - since})));
        }
        const double error = relative_difference(r.trace.column(0), rigid);
        EXPECT_LT(relative_difference(r.trace.column(0), delayed), 0.25 * error) << ratio;
        if (last > 0) { EXPECT_NEAR(std::log2(last / error), 1, 0.1) << ratio; }
        last = error;
    }
    EXPECT_LT(last, 0.06);
}

}  // namespace
}  // namespace jvari
