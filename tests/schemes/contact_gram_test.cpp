// The vector contact equation against references in long double: coordinate-wise bisection where
// Theta has full rank, one bisection on X = g.f where Theta = g g' has rank one.
#include "schemes/contact/contact_gram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "schemes/contact/few_contacts.hpp"
#include "tests/schemes/contact_points.hpp"

namespace jvari {
namespace {

Real force_over(const ContactLaw& law, Real eta, Real r) {  // [V(eta) - V(eta - r)]/r
    // midpoint and its first correction: relative error (r/eta)^4
    if (std::abs(r) < 1e-7L * std::abs(eta)) {
        if (eta <= 0) return 0;
        const Real mid = eta - r / 2, a = law.alpha;
        return law.k * std::pow(mid, a) * (1 + a * (a - 1) / 24 * (r / mid) * (r / mid));
    }
    return r == 0 ? 0 : (potential(law, eta) - potential(law, eta - r)) / r;
}

template <class Rising>
Real root(Rising rising, Real low, Real high) {
    for (int i = 0; i < 400; ++i) {
        const Real mid = low + (high - low) / 2;
        (rising(mid) > 0 ? high : low) = mid;
    }
    return low + (high - low) / 2;
}

struct Problem {
    std::vector<ContactLaw> laws;
    std::vector<double> theta, eta, b;
    std::vector<StepLoss> loss = {};  // none: nothing is lost
    int n() const { return static_cast<int>(laws.size()); }
    Real factor(int a, Real r) const {
        if (loss.empty()) return 1;
        const Real w = 1 - loss[a].kappa * r;
        return loss[a].clipped && w < 0 ? 0 : w;
    }
};

struct Answer {
    std::vector<Real> r, f;
};

// Gauss-Seidel on the forces: each falls out of a monotone scalar equation.
Answer sweep_reference(const Problem& p) {
    const int n = p.n();
    Answer s{std::vector<Real>(n), std::vector<Real>(n, 0)};
    for (int sweep = 0; sweep < 4000; ++sweep) {
        Real change = 0, largest = 0;
        for (int a = 0; a < n; ++a) {
            Real offset = p.b[a];
            for (int c = 0; c < n; ++c)
                if (c != a) offset -= static_cast<Real>(p.theta[a * n + c]) * s.f[c];
            const Real theta = p.theta[a * n + a], eta = p.eta[a];
            Real f = 0;
            if (eta > 0 || eta + offset > 0) {
                const Real far = std::sqrt(2 * theta * potential(p.laws[a], eta) * 4) +
                                 std::abs(offset) + std::abs(eta);
                const auto g = [&](Real r) {
                    return r + offset - theta * force_over(p.laws[a], eta, r) * p.factor(a, r);
                };
                const Real r = !p.loss.empty() && -offset * p.loss[a].kappa > 1
                                   ? root(g, 1 / p.loss[a].kappa, -offset)
                                   : root(g, -offset, -offset + 4 * far);
                f = (r + offset) / theta;
                if (theta * p.laws[a].k *
                        std::pow(std::max<Real>(eta - r, 0),
                                 static_cast<Real>(p.laws[a].alpha) - 1) <
                    1)
                    f = force_over(p.laws[a], eta, r) * p.factor(a, r);
            }
            change = std::max(change, std::abs(f - s.f[a]));
            largest = std::max(largest, std::abs(f));
            s.f[a] = f;
        }
        if (change <= 1e-16L * largest) break;
    }
    for (int a = 0; a < n; ++a) {
        s.r[a] = -static_cast<Real>(p.b[a]);
        for (int c = 0; c < n; ++c) s.r[a] += static_cast<Real>(p.theta[a * n + c]) * s.f[c];
    }
    return s;
}

Answer rank_one_reference(const Problem& p, const std::vector<double>& g) {
    const auto h = [&](Real X) {
        Real sum = X;
        for (int a = 0; a < p.n(); ++a)
            sum -= g[a] * force_over(p.laws[a], p.eta[a], -static_cast<Real>(p.b[a]) + g[a] * X);
        return sum;
    };
    Real far = 1e-12L;
    while (h(far) < 0 || h(-far) > 0) far *= 4;
    const Real X = root(h, -far, far);
    Answer s;
    for (int a = 0; a < p.n(); ++a) s.r.push_back(-static_cast<Real>(p.b[a]) + g[a] * X);
    return s;
}

struct Solved {
    std::vector<double> r, f;
    GramSolution info;
    double lost = 0;
};
Solved solve(const Problem& p) {
    ContactGram gram(p.laws, p.theta);
    gram.lose(p.loss);
    Solved s{std::vector<double>(p.n()), std::vector<double>(p.n()), {}};
    s.info = gram.solve(p.eta.data(), p.b.data(), s.r.data(), s.f.data());
    s.lost = gram.lost();
    return s;
}

Real reach(const Problem& p, const std::vector<double>& f, int a) {
    Real sum = std::abs(p.b[a]) + std::abs(p.eta[a]);
    for (int c = 0; c < p.n(); ++c) sum += std::abs(p.theta[a * p.n() + c] * f[c]);
    return sum;
}

struct Draw {
    std::mt19937 random{7};
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    double power(double low, double high) { return std::pow(10.0, uniform(low, high)); }
    Problem contacts(int n) {
        Problem p;
        const double scale = power(-9, -4), alphas[] = {1, 1, 1.3, 1.5, 2, 2.5, 3};
        const bool same = uniform(0, 1) < 0.5;
        const ContactLaw common{power(2, 16), alphas[static_cast<int>(uniform(0, 7))]};
        for (int a = 0; a < n; ++a) {
            p.laws.push_back(
                same ? common : ContactLaw{power(2, 16), alphas[static_cast<int>(uniform(0, 7))]});
            const double what = uniform(0, 1);
            p.eta.push_back(what < 0.15  ? 0.0
                            : what < 0.6 ? -scale * uniform(0, 1)
                                         : scale * power(-6, 0));
            p.b.push_back(scale * uniform(-2, 2));
            // grazing: the force-free motion ends exactly at the surface
            if (uniform(0, 1) < 0.1) p.b[a] = -p.eta[a];
            if (uniform(0, 1) < 0.05) p.b[a] = 0;
        }
        return p;
    }
    void couple(Problem& p, double size) {
        const int n = p.n();
        std::vector<double> g(n * (n + 2));
        for (double& x : g) x = uniform(-0.3, 1);
        p.theta.assign(n * n, 0.0);
        for (int a = 0; a < n; ++a)
            for (int c = 0; c < n; ++c)
                for (int l = 0; l < n + 2; ++l)
                    p.theta[a * n + c] += size * g[a * (n + 2) + l] * g[c * (n + 2) + l] / (n + 2);
        // the reference's sweeps converge at a rate of the coupling
        for (int a = 0; a < n; ++a) p.theta[a * n + a] *= 1.5;
    }
};

void agrees_with_bisection(bool losing) {
    Draw draw;
    int most = 0, pulled = 0;
    double worst_r = 0, worst_f = 0, worst_residual = 0;
    for (int trial = 0; trial < 300; ++trial) {
        for (int n : {1, 2, 5}) {
            Problem p = draw.contacts(n);
            const double size = draw.power(-6, -2);
            draw.couple(p, size);
            for (int a = 0; losing && a < n; ++a)
                p.loss.push_back({draw.power(1, 8), draw.uniform(0, 1) < 0.5});
            const Answer want = sweep_reference(p);
            const Solved got = solve(p);
            ASSERT_TRUE(got.info.converged) << trial << " n " << n;
            most = std::max(most, got.info.iterations);
            if (n > 1) worst_residual = std::max(worst_residual, got.info.residual);
            Real largest = 0;
            for (Real f : want.f) largest = std::max(largest, std::abs(f));
            for (int a = 0; a < n; ++a) {
                if (p.factor(a, got.r[a]) >= 0) {
                    ASSERT_GE(got.f[a], 0) << trial;
                } else ++pulled;
                const double error = std::abs(got.r[a] - want.r[a]) / reach(p, got.f, a);
                worst_r = std::max(worst_r, reach(p, got.f, a) > 0 ? error : 0);
                if (n == 1) {
                    EXPECT_NEAR(p.theta[0] * got.f[0], got.r[0] + p.b[0],
                                1e-12 * static_cast<double>(reach(p, got.f, 0)))
                        << trial;
                }
                // of a force that moves something
                const Real scale =
                    std::max(largest, 1e-3L * reach(p, got.f, a) / p.theta[a * n + a]);
                if (n > 1 && scale > 0)
                    worst_f = std::max(worst_f,
                                       static_cast<double>(std::abs(got.f[a] - want.f[a]) / scale));
            }
        }
    }
    EXPECT_LT(worst_r, 1e-13);
    EXPECT_LT(worst_f, 1e-11);
    EXPECT_LT(worst_residual, 1e-12);
    EXPECT_LE(most, 30);
    EXPECT_EQ(pulled > 50, losing);
    std::printf("[ measured ] r %.1e, f %.1e, residual %.1e, iterations %d, pulled %d\n", worst_r,
                worst_f, worst_residual, most, pulled);
}

TEST(ContactGram, AgreesWithCoordinatewiseBisectionInLongDouble) { agrees_with_bisection(false); }
TEST(ContactGram, WithLossesAgreesWithCoordinatewiseBisectionInLongDouble) {
    agrees_with_bisection(true);
}

template <int n>
void few_agree_with_bisection() {
    Draw draw;
    int not_ended = 0, most = 0;
    double worst_r = 0, worst_f = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        Problem p = draw.contacts(n);
        for (ContactLaw& law : p.laws) law.alpha = 1;
        draw.couple(p, draw.power(-6, -2));
        const FewContacts few(p.laws, p.theta);
        double r[n];
        std::vector<double> f(n);
        const int iterations = few.solve<n>(p.eta.data(), p.b.data(), r, f.data());
        if (iterations < 0) {
            ++not_ended;
            continue;
        }
        most = std::max(most, iterations);
        const Answer want = sweep_reference(p);
        Real largest = 0;
        for (Real x : want.f) largest = std::max(largest, std::abs(x));
        for (int a = 0; a < n; ++a) {
            const Real size = reach(p, f, a),
                       scale = std::max(largest, 1e-3L * size / p.theta[a * n + a]);
            if (!(size > 0)) continue;
            worst_r = std::max(worst_r, static_cast<double>(std::abs(r[a] - want.r[a]) / size));
            worst_f = std::max(worst_f, static_cast<double>(std::abs(f[a] - want.f[a]) / scale));
        }
    }
    EXPECT_LT(worst_r, 1e-13);
    EXPECT_LT(worst_f, 1e-11);
    EXPECT_LE(not_ended, 10);  // of 1 000: the general form has them
    std::printf("[ measured ] %d contacts: r %.1e, f %.1e, iterations %d, not ended %d\n", n,
                worst_r, worst_f, most, not_ended);
}
TEST(ContactGram, FewLinearContactsAgreeWithBisection) {
    few_agree_with_bisection<2>();
    few_agree_with_bisection<3>();
    few_agree_with_bisection<5>();
}

TEST(ContactGram, ASingularThetaHasOneMotionAndItIsFound) {
    Draw draw;
    int most = 0;
    double worst = 0;
    for (int trial = 0; trial < 400; ++trial) {
        for (int n : {2, 5}) {
            Problem p = draw.contacts(n);
            const double size = draw.power(-3, -1);
            std::vector<double> g;
            for (int a = 0; a < n; ++a) g.push_back(size * draw.uniform(-0.2, 1));
            for (int a = 0; a < n; ++a)
                for (int c = 0; c < n; ++c) p.theta.push_back(g[a] * g[c]);
            const Answer want = rank_one_reference(p, g);
            const Solved got = solve(p);
            ASSERT_TRUE(got.info.converged) << trial << " n " << n;
            most = std::max(most, got.info.iterations);
            for (int a = 0; a < n; ++a)
                if (const Real scale = reach(p, got.f, a); scale > 0)
                    worst = std::max(worst,
                                     static_cast<double>(std::abs(got.r[a] - want.r[a]) / scale));
        }
    }
    EXPECT_LT(worst, 1e-13);
    EXPECT_LE(most, 25);
    std::printf("[ measured ] r %.1e, iterations %d\n", worst, most);
}

TEST(ContactGram, WorkOfTheForcesIsTheLossOfPotential) {
    Draw draw;
    for (int trial = 0; trial < 200; ++trial) {
        Problem p = draw.contacts(3);
        p.theta = {2e-4, 1e-4, 0, 1e-4, 3e-4, 1e-4, 0, 1e-4, 2e-4};
        const Solved s = solve(p);
        ASSERT_TRUE(s.info.converged);
        for (int a = 0; a < 3; ++a) {
            const Real work = static_cast<Real>(s.f[a]) * s.r[a];
            const Real lost = potential(p.laws[a], p.eta[a]) -
                              potential(p.laws[a], static_cast<Real>(p.eta[a]) - s.r[a]);
            // r is a double: its last bit moves the potential by F' r eps
            const double slope = p.laws[a].force(std::abs(p.eta[a] - s.r[a])) * 4e-15 *
                                 static_cast<double>(reach(p, s.f, a));
            EXPECT_NEAR(static_cast<double>(work - lost), 0,
                        1e-9 * std::abs(static_cast<double>(work)) + 10 * slope)
                << trial;
        }
    }
}

// Each pushes its neighbours alone: all of them are one system, whatever their order.
TEST(ContactGram, ContactsInAChainAreSolvedTogether) {
    Draw draw;
    const int order[] = {3, 0, 4, 1, 2};  // of five along the string
    for (int trial = 0; trial < 100; ++trial) {
        Problem p = draw.contacts(5);
        p.theta.assign(25, 0.0);
        for (int i = 0; i < 5; ++i) p.theta[order[i] * 6] = 3e-4;
        for (int i = 1; i < 5; ++i)
            p.theta[order[i] * 5 + order[i - 1]] = p.theta[order[i - 1] * 5 + order[i]] = 1e-4;
        const Answer want = sweep_reference(p);
        const Solved got = solve(p);
        ASSERT_TRUE(got.info.converged) << trial;
        for (int a = 0; a < 5; ++a)
            EXPECT_LE(std::abs(got.r[a] - want.r[a]), 1e-13L * reach(p, got.f, a))
                << trial << " contact " << a;
    }
}

TEST(ContactGram, UncoupledContactsAreScalarSolvesToTheBit) {
    Draw draw;
    for (int trial = 0; trial < 100; ++trial) {
        Problem p = draw.contacts(4);
        p.theta.assign(16, 0.0);
        for (int a = 0; a < 4; ++a) p.theta[a * 5] = draw.power(-6, -2);
        const Solved s = solve(p);
        for (int a = 0; a < 4; ++a) {
            const ContactSolution one = solve_contact(p.laws[a], p.eta[a], p.b[a], p.theta[a * 5]);
            EXPECT_EQ(s.r[a], one.r);
            EXPECT_EQ(s.f[a], one.force);
        }
    }
}

TEST(ContactGram, ContactsThatAllStayOutMoveFreely) {
    Problem p;
    p.laws = {{1e8, 1}, {1e8, 1.5}};
    p.theta = {1e-4, 1e-4, 1e-4, 1e-4};
    p.eta = {-1e-3, 0};
    p.b = {1e-4, -1e-4};
    const Solved s = solve(p);
    EXPECT_EQ(s.r[0], -1e-4);
    EXPECT_EQ(s.r[1], 1e-4);
    EXPECT_EQ(s.f[0], 0);
    EXPECT_EQ(s.f[1], 0);
    EXPECT_EQ(s.info.iterations, 0);
}

}  // namespace
}  // namespace jvari
