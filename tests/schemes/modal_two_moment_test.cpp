// modal_two_moment: the figures of docs/two-moments.md, one contact over random steps, the ladder
// against small steps, and forces as lines of a motion that is known.
#include <random>

#include "schemes/moments/exact_ladder.hpp"
#include "schemes/moments/moment_contact.hpp"
#include "schemes/moments/moment_obstacle.hpp"
#include "tests/c3.hpp"
#include "tests/claims.hpp"

namespace jvari {
namespace {

constexpr double x1 = 44100;

// Compliances as strings have them: a turn of the phase, and little else off the diagonal.
struct Draw {
    std::mt19937_64 random{20261129};
    double unit() { return std::uniform_real_distribution<double>(-1, 1)(random); }
    double decades(double most) { return std::pow(10, most * unit()); }
    MomentMatrix compliance() {
        const double t_00 = decades(1), t_11 = t_00 * (0.07 + 0.5 * std::abs(unit())),
                     even = 0.03 * unit() * std::sqrt(t_00 * t_11),
                     odd = t_00 * (0.02 + 0.3 * std::abs(unit()));
        return {t_00, even - odd, even + odd, t_11};
    }
    double small(double decades_of_it) {
        return unit() * std::pow(10, decades_of_it * std::min(0.0, unit()));
    }
};

// How far the forces are from what the ends of their line say: (6) of docs/two-moments.md.
double misfit(const ContactLaw& law, const MomentContact& s) {
    using Real = long double;  // of ends that are near to each other
    const auto V = [&law](Real eta) {
        return eta > 0 ? law.k * std::pow(eta, Real(law.alpha) + 1) / (law.alpha + 1) : Real(0);
    };
    const Real d = Real(s.to) - s.from;
    const double mean = d == 0 ? law.force(s.from) : static_cast<double>((V(s.to) - V(s.from)) / d);
    return std::abs(s.phi_0 - mean) + std::abs(s.phi_0 - s.phi_1 - law.force(s.from));
}

TEST(MomentContacts, SolveEachOfAMillionStepsByRuleD) {
    Draw draw;
    for (int n = 0; n < 1000000; ++n) {
        const ContactLaw law{draw.decades(8), 1};
        const MomentMatrix T = draw.compliance();
        const double eta = draw.small(6), b_0 = draw.unit(), b_1 = draw.small(2);
        const MomentRule rule(law, 0, LossLaw::hunt_crossley, T, 1);
        ASSERT_FALSE(rule.conserves());
        MomentContact s;
        rule.solve(T, eta, b_0, b_1, s);
        const double r_0 = b_0 + T.m00 * s.phi_0 + T.m01 * s.phi_1,
                     r_1 = b_1 + T.m10 * s.phi_0 + T.m11 * s.phi_1,
                     reach = std::abs(eta) + std::abs(b_0) + std::abs(b_1) +
                             T.m00 * (std::abs(s.phi_0) + std::abs(s.phi_1));
        ASSERT_NEAR(eta - r_0, s.to, 1e-12 * reach) << n;
        ASSERT_NEAR(eta + r_1, s.from, 1e-12 * reach) << n;
        ASSERT_GE(s.phi_0, 0) << n;
        ASSERT_GE(rule.lost(eta, s), 0) << n;
        const double work = s.phi_0 * (eta - s.to) + s.phi_1 * (s.from - eta),
                     size = law.potential(eta) + law.potential(s.to) + std::abs(work) +
                            rule.lost(eta, s);
        ASSERT_NEAR(law.potential(s.to) - law.potential(eta), -work - rule.lost(eta, s),
                    1e-12 * size)
            << n;
    }
}

// The four cases of exponent 1, each looked for by itself: exactly one is there.
TEST(MomentContacts, HaveOneSolutionInEachStep) {
    Draw draw;
    using Real = long double;
    for (int n = 0; n < 1000000; ++n) {
        const Real k = draw.decades(8);
        const MomentMatrix m = draw.compliance();
        const Real t_00 = m.m00, t_01 = m.m01, t_10 = m.m10, t_11 = m.m11, eta = draw.small(6),
                   E_1 = eta - draw.unit(), E_0 = eta + draw.small(2);
        int found = E_0 <= 0 && E_1 <= 0;
        const Real a = 1 + k * t_00, b = 1 + k * t_01, c = 1 - k * t_10, d = -1 - k * t_11,
                   det = a * d - b * c, u_0 = (d * E_1 - b * E_0) / det,
                   u_1 = (a * E_0 - c * E_1) / det;
        found += u_0 - u_1 > 0 && u_0 + u_1 > 0;
        const auto roots = [&](Real A, Real B, Real C, auto fits) {
            const Real square = B * B - 4 * A * C;
            if (square < 0) return;
            const Real half = -0.5L * (B + std::copysign(std::sqrt(square), B));
            found += half != 0 && fits(C / half);
            found += A != 0 && fits(half / A);
        };
        const Real A_0 = t_00 + t_01, A_1 = t_10 + t_11, sum = A_0 + A_1;
        roots(k * A_0 * A_0 + 2 * sum, -2 * k * E_1 * A_0 - 2 * (E_1 - E_0), k * E_1 * E_1,
              [&](Real p) { return p > 0 && E_0 + A_1 * p <= 0 && E_1 - A_0 * p > 0; });
        const Real q = 1 + k * t_11, x_0 = E_0 / q, x_1 = A_1 / q, y_0 = E_1 + t_01 * k * x_0,
                   y_1 = -A_0 + t_01 * k * x_1;
        roots(2 * (x_1 - y_1) - k * x_1 * x_1, 2 * (x_0 - y_0) - 2 * k * x_0 * x_1, -k * x_0 * x_0,
              [&](Real p) { return p > 0 && x_0 + x_1 * p > 0 && y_0 + y_1 * p <= 0; });
        ASSERT_EQ(found, 1) << n;
    }
}

TEST(MomentContacts, OfPowerLawsEndWhereTheirForcesAreThoseOfTheirEnds) {
    Draw draw;
    for (const double exponent : {1.5, 2.0, 2.5, 3.0, 3.3})
        for (int n = 0; n < 40000; ++n) {
            const ContactLaw law{draw.decades(6), exponent};
            const MomentMatrix T = draw.compliance();
            const double eta = draw.small(6), b_0 = draw.unit(), b_1 = draw.small(2);
            const MomentRule rule(law, 0, LossLaw::hunt_crossley, T, 1);
            MomentContact s;
            rule.solve(T, eta, b_0, b_1, s);
            ASSERT_TRUE(s.converged) << exponent << " " << n;
            const double reach = std::abs(eta) + std::abs(b_0) + std::abs(b_1) +
                                 T.m00 * (std::abs(s.phi_0) + std::abs(s.phi_1)),
                         rounding = 1e-14 * reach * law.slope(std::max(s.from, s.to));
            // forces far below the law's have fewer digits
            if (std::abs(s.phi_0) > 1e-10 * law.force(reach)) {
                ASSERT_LE(misfit(law, s), 1e-9 * (std::abs(s.phi_0) + std::abs(s.phi_1)) + rounding)
                    << exponent << " " << n;
            }
            ASSERT_NEAR(eta - b_0 - T.m00 * s.phi_0 - T.m01 * s.phi_1, s.to, 1e-11 * reach) << n;
            ASSERT_NEAR(eta + b_1 + T.m10 * s.phi_0 + T.m11 * s.phi_1, s.from, 1e-11 * reach) << n;
        }
}

TEST(MomentContacts, ThatLoseArePassive) {
    Draw draw;
    for (const LossLaw loss : {LossLaw::hunt_crossley, LossLaw::clipped})
        for (const bool light : {false, true})  // rule G takes a contact that bounces in a step
            for (int n = 0; n < 20000; ++n) {
                const ContactLaw law{draw.decades(4), n % 2 ? 1 : 2.5};
                MomentMatrix T = draw.compliance();
                if (light) T.m11 *= 0.02;
                const double eta = draw.small(3), b_0 = draw.unit(), b_1 = draw.small(2);
                const MomentRule rule(law, draw.decades(1.5), loss, T, 1);
                ASSERT_EQ(rule.conserves(), light);
                MomentContact s;
                rule.solve(T, eta, b_0, b_1, s);
                const double r_0 = b_0 + T.m00 * s.phi_0 + T.m01 * s.phi_1,
                             r_1 = b_1 + T.m10 * s.phi_0 + T.m11 * s.phi_1,
                             work = s.phi_0 * r_0 + s.phi_1 * r_1,
                             size = law.potential(eta) + law.potential(s.to) + std::abs(work);
                ASSERT_TRUE(s.converged) << n;
                ASSERT_GE(rule.lost(eta, s), -1e-13 * size) << n;
                const double rounding = 1e-10 * (std::abs(s.phi_0) + std::abs(s.phi_1)) *
                                        (std::abs(eta) + std::abs(b_0) + std::abs(b_1));
                ASSERT_NEAR(law.potential(s.to) - law.potential(eta), -work - rule.lost(eta, s),
                            1e-9 * size + rounding)
                    << n;
                // rule G has the force of a power by quadrature
                const double least = light ? -1e-3 : -1e-9;
                if (loss == LossLaw::clipped) {
                    ASSERT_GE(T.m00 * s.phi_0, least * (std::abs(b_0) + std::abs(eta))) << n;
                }
            }
}

// By the Runge-Kutta method in 20 000 steps: R (d' - v) = M v' = u - d/c.
// Theta of `points` points on a string with random modes, means first: (2) of docs/two-moments.md.
std::vector<double> compliances(Draw& draw, int points) {
    const int D = 2 * points;
    std::vector<double> theta(static_cast<std::size_t>(D) * D), g(points);
    for (int mode = 1; mode <= 30; ++mode) {
        const double z = 0.5 * std::numbers::pi * (1 + draw.unit()), S_0 = 2 * std::sin(z),
                     S_1 = 2 * (std::sin(z) / z - std::cos(z));
        for (double& x : g) x = draw.unit() / mode;
        for (int p = 0; p < points; ++p)
            for (int q = 0; q < points; ++q) {
                const double both = g[p] * g[q];
                theta[p * D + q] += 0.5 * S_0 * S_0 * both;
                theta[(points + p) * D + points + q] += 0.5 * S_1 * S_1 * both;
                theta[p * D + points + q] -= std::cos(z) * S_1 * both;
                theta[(points + p) * D + q] += std::cos(z) * S_1 * both;
            }
    }
    return theta;
}

// Each contact's forces are those of the ends of its line, whichever contacts reach their barriers.
TEST(MomentContacts, OfSeveralPointsSolveEveryPointsEquation) {
    Draw draw;
    for (int n = 2; n <= 5; ++n)
        for (int trial = 0; trial < 1500; ++trial) {
            const std::vector<double> theta = compliances(draw, n);
            Contacts contacts;
            std::vector<double> eta(n), reading(n), free(2 * n), force(2 * n);
            for (int a = 0; a < n; ++a) {
                contacts.add({draw.decades(5) / theta[a * 2 * n + a], 1}, 0, 0);
                eta[a] = -std::abs(draw.small(3));
                reading[a] = -eta[a];
            }
            MomentObstacle obstacle(contacts, {}, theta, 1, nullptr);
            obstacle.begin(reading.data(), nullptr, force.data());
            for (int step = 0; step < 8; ++step) {
                for (int a = 0; a < n; ++a) free[a] = draw.unit(), free[n + a] = draw.small(2);
                ASSERT_TRUE((obstacle.step<0, false, false>(free.data(), force.data())));
                double largest = 0, reach = 0;
                for (int a = 0; a < n; ++a) {
                    largest = std::max(largest, std::abs(force[a]) + std::abs(force[n + a]));
                    reach = std::max(reach, std::abs(eta[a]) + std::abs(free[a]));
                }
                for (int a = 0; a < n; ++a) {
                    MomentContact s;
                    s.phi_0 = force[a], s.phi_1 = force[n + a];
                    s.to = eta[a] - free[a], s.from = eta[a] + free[n + a];
                    for (int k = 0; k < 2 * n; ++k) {
                        s.to -= theta[a * 2 * n + k] * force[k];
                        s.from += theta[(n + a) * 2 * n + k] * force[k];
                    }
                    const ContactLaw& law = contacts.laws[a];
                    ASSERT_LE(misfit(law, s), 1e-9 * largest + 1e-13 * law.k * reach)
                        << n << " " << trial << " " << step << " " << a;
                    eta[a] -= obstacle.moved()[a];
                    ASSERT_NEAR(eta[a], s.to, 1e-12 * reach);
                }
            }
        }
}

TEST(ExactLadders, MoveAndLoseAsSmallStepsSay) {
    MissingMatrix m;
    m.contacts = 1;
    m.C = {1e-5};
    m.ladder = {{0}, {1}, {2e-7}, {0.12}};
    const double H = 1 / x1, c = 1e-5, M = 2e-7, R = 0.12, u_0 = 0.3, u_1 = -0.7;
    const ExactLadder ladder(m, H);
    const auto& by = ladder.pattern(0).by;
    const double x[4] = {2e-6, 0.05, u_0, u_1};
    double d = x[0], v = x[1], mean = 0, first = 0, lost = 0;
    const int steps = 20000;
    const double h = H / steps;
    const auto slope = [&](double s, double d_, double v_) {
        const double push = u_0 + u_1 * (2 * s - 1) - d_ / c;
        return std::array<double, 3>{push / R + v_, push / M, push * push / R};
    };
    for (int n = 0; n < steps; ++n) {
        const double s = static_cast<double>(n) / steps, ds = 1.0 / steps;
        const auto k_1 = slope(s, d, v),
                   k_2 = slope(s + ds / 2, d + h / 2 * k_1[0], v + h / 2 * k_1[1]),
                   k_3 = slope(s + ds / 2, d + h / 2 * k_2[0], v + h / 2 * k_2[1]),
                   k_4 = slope(s + ds, d + h * k_3[0], v + h * k_3[1]);
        const auto sum = [&](int i, double w_1, double w_2, double w_4) {
            return h * (w_1 * k_1[i] + w_2 * (k_2[i] + k_3[i]) + w_4 * k_4[i]);
        };
        const double moved = sum(0, 1.0 / 6, 1.0 / 3, 1.0 / 6);
        mean += moved;
        first += sum(0, (2 * s - 1) / 6, (2 * s + ds - 1) / 3, (2 * s + 2 * ds - 1) / 6);
        lost += sum(2, 1.0 / 6, 1.0 / 3, 1.0 / 6);
        v += sum(1, 1.0 / 6, 1.0 / 3, 1.0 / 6);
        d += moved;
    }
    const auto exact = [&](int row) {
        double sum = 0;
        for (int i = 0; i < 4; ++i) sum += by[row][i] * x[i];
        return sum;
    };
    EXPECT_NEAR(exact(0), mean, 1e-9 * std::abs(mean));
    EXPECT_NEAR(exact(1), first, 1e-7 * std::abs(first));
    EXPECT_NEAR(exact(2), v - x[1], 1e-9 * std::abs(v - x[1]));
    const double state[2] = {x[0], x[1]}, force[2] = {u_0, u_1};
    EXPECT_NEAR(ladder.lost(state, force), lost, 1e-9 * lost);
    const double after[2] = {x[0] + exact(0), x[1] + exact(2)};
    EXPECT_NEAR(ladder.stored(after) - ladder.stored(state),
                u_0 * exact(0) + u_1 * exact(1) - ladder.lost(state, force),
                1e-12 * ladder.stored(after));
}

// Over 50 ms against the exact solution of the whole string.
TEST(TwoMoments, ErrAsTheirTableSays) {
    const Scene scene = lasting(c3_release(), 0.05);
    const auto truth = play("exact_contact compliance=matched", scene, {0, x1, 1064, {}});
    const auto error = [&](const char* form, int modes, double times) {
        return apart(play(form, scene, {times * x1, x1, modes, {}}), truth, 0);
    };
    EXPECT_LE(error("modal_two_moment compliance=matched", 133, 1), 4.4e-3);
    EXPECT_LE(error("modal_two_moment compliance=matched", 200, 2), 8.0e-4);
    EXPECT_LE(error("modal_two_moment compliance=matched", 266, 4), 3.9e-4);
}

TEST(TwoMoments, ErrInTimeAloneByOrderTwoAndMore) {
    const Scene scene = lasting(c3_release(), 0.05);
    const std::string form = "modal_two_moment compliance=matched";
    const auto truth = play(form, scene, {64 * x1, x1, 133, {}});
    const double most[] = {2.2e-3, 4.5e-4, 1e-4, 1.6e-5};
    for (int k = 0; k < 4; ++k)
        EXPECT_LE(apart(play(form, scene, {(1 << k) * x1, x1, 133, {}}), truth, 0), most[k]) << k;
}

// A hammer of 5 g on a string of piano's C4, exponent 2.5, with and without loss.
Scene struck() {
    Scene scene = c3_free();
    String& s = scene.strings[0];
    s.length = 0.62, s.linear_density = 6.165e-3, s.tension = 648.9, s.bending_stiffness = 9.82e-3;
    s.damping = PolynomialDamping{0.5, 5e-3, 1e-6};
    Mass hammer;
    hammer.position = 0.0744, hammer.width = 2e-3, hammer.mass = 5e-3, hammer.velocity = 2;
    hammer.stiffness = 4e8, hammer.exponent = 2.5, hammer.contact_loss = 0.3;
    s.masses = {hammer};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}};
    return lasting(scene, 0.02);
}

TEST(TwoMoments, FollowAHammerThatLosesByOrderThree) {
    const Scene scene = struck();
    const auto truth = play("exact_contact", scene, {0, x1, 50, {}});
    const double most[] = {4e-5, 5e-6, 7e-7, 9e-8};
    for (int k = 0; k < 4; ++k)
        EXPECT_LE(apart(play("modal_two_moment", scene, {(1 << k) * x1, x1, 50, {}}), truth, 0),
                  most[k])
            << k;
}

TEST(TwoMoments, FollowALossyBarrierAndAWideFootprint) {
    Scene lossy = lasting(c3_release(), 0.05);
    barrier(lossy).position = 0.1, barrier(lossy).stiffness.k = 1e5,
    barrier(lossy).contact_loss = 10;
    const auto error = [](const Scene& scene, const char* form, int reference_modes) {
        const auto truth = play("exact_contact", scene, {0, x1, reference_modes, {}}),
                   run = play(form, scene, {x1, x1, 133, {}});
        EXPECT_EQ(fact(run, "conserving_contacts"), 1);
        return apart(run, truth, 0);
    };
    EXPECT_LE(error(lossy, "modal_two_moment", 133), 2e-2);
    Scene wide = lasting(c3_release(), 0.02);
    barrier(wide).position = 0.1, barrier(wide).width = 0.03;
    EXPECT_LE(error(wide, "modal_two_moment compliance=matched", 1064), 6e-2);
}

// Modes above half the rate move as they should: at every row that two rates share.
TEST(TwoMoments, AreExactInFreeMotionAboveHalfTheRateToo) {
    Scene scene = lasting(lossless(c3_free()), 0.02);
    scene.strings[0].start = TriangleShape{0.37, 1e-3, 0.01};
    scene.taps.push_back({"v", Quantity::velocity, 0, 0.4});
    const auto truth = play("exact_linear", scene, {0, x1, 200, {}});
    const auto run = play("modal_two_moment", scene, {x1, x1, 200, {}});
    for (int tap = 0; tap < 3; ++tap) EXPECT_LE(apart(run, truth, tap), 1e-11) << tap;
}

// Two barriers at one place, each half as stiff, are one.
TEST(TwoMoments, ShareAPointsForceBetweenTwoBarriers) {
    const Scene one = lasting(c3_release(), 0.02);
    Scene two = one;
    barrier(two).stiffness.k /= 2;
    two.strings[0].barriers.push_back(two.strings[0].barriers[0]);
    const auto a = play("modal_two_moment", one, {2 * x1, x1, 100, {}}),
               b = play("modal_two_moment", two, {2 * x1, x1, 100, {}});
    for (int tap = 0; tap < 4; ++tap) EXPECT_LE(apart(b, a, tap), 1e-9) << tap;
}

// A force that is over within a step leaves its whole impulse.
TEST(TwoMoments, TakeTheImpulseOfAPulseShorterThanAStep) {
    Scene scene = lasting(lossless(c3_free()), 4.0 / x1);
    scene.strings[0].pluck = Pluck{100, 20e-6, 0, 1.2 / x1, 0.31, 0};
    scene.taps = {{"v", Quantity::velocity, 0, 0.31}};
    const auto a = play("modal_two_moment", scene, {x1, x1, 3, {}}),
               b = play("modal_two_moment", scene, {512 * x1, x1, 3, {}});
    EXPECT_GT(std::abs(a.trace.column(0)[3]), 1);
    EXPECT_LE(apart(a, b, 0), 1e-4);
}

std::vector<Scene> bridges() {
    std::vector<Scene> all;
    for (const double k : {1e2, 1e5, 4.39e8, 1e12, 1e16, HUGE_VAL})
        for (const int barriers : {1, 4}) {
            Scene scene = lasting(c3_release(), 0.01);
            barrier(scene).stiffness.k = k;
            for (int b = 1; b < barriers; ++b) {
                scene.strings[0].barriers.push_back(scene.strings[0].barriers[0]);
                barrier(scene, b).position += 3e-3 * b;
            }
            scene.name += " " + std::to_string(k) + " on " + std::to_string(barriers);
            all.push_back(scene);
        }
    for (const double exponent : {1.5, 2.0, 3.0})
        for (const int barriers : {1, 3}) {
            Scene scene = with_exponent(lasting(c3_release(), 0.01), exponent);
            barrier(scene).stiffness.k = 1e10;
            for (int b = 1; b < barriers; ++b) {
                scene.strings[0].barriers.push_back(scene.strings[0].barriers[0]);
                barrier(scene, b).position += 3e-3 * b;
            }
            scene.name += " exponent " + std::to_string(exponent);
            all.push_back(scene);
        }
    all.push_back(struck());
    all.push_back(lasting(c3_pluck(), 0.01));
    all.back().strings[0].pluck = Pluck{-0.4, 5e-3, 30, 1e-3, 0.02, 0.01};
    return all;
}

TEST(TwoMoments, KeepTheirEnergyInEveryStep) {
    holds(LedgerClaim("", {"modal_two_moment", "modal_two_moment compliance=matched"}, bridges(),
                      {{x1, 4 * x1}, 0, 100}, {1e-13, 1e-11}, {.least = -1e-18}));
}

}  // namespace
}  // namespace jvari
