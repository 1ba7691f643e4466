// The scalar contact equation against a bisection in long double: every case, stiffness 1e2 to
// 1e16, exponents 1 to 3.
#include "schemes/contact/contact.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "tests/schemes/contact_points.hpp"

namespace jvari {
namespace {

struct Truth {
    Real r, force;
};

// mean force [V(eta) - V(eta - r)]/r, by quadrature-free series near r = 0
Real mean_force(const ContactLaw& law, Real eta, Real r) {
    if (eta > 0 && std::abs(r) < Real(1e-5) * eta) {
        const Real a = law.alpha, z = -r / eta;
        return law.k * std::pow(eta, a) *
               (1 +
                a / 2 * z * (1 + (a - 1) / 3 * z * (1 + (a - 2) / 4 * z * (1 + (a - 3) / 5 * z))));
    }
    return (potential(law, eta) - potential(law, eta - r)) / r;
}

// Bisection on r for a string that stays or leaves, on the depth eta - r for one that enters:
// nothing shared with the solver.
Truth bisect(const ContactLaw& law, Real eta, Real b, Real theta) {
    if (eta <= 0 && eta + b <= 0) return {-b, 0};
    const bool enters = eta <= 0;
    Real low = enters ? 0 : -b, high = enters ? eta + b : -b;
    const auto residual = [&](Real s) {
        if (enters) return s - (eta + b) + theta * potential(law, s) / (s - eta);
        return s + b - theta * mean_force(law, eta, s);
    };
    if (!enters)
        for (Real grow = eta + std::abs(b); residual(high) < 0; grow *= 2) high = low + grow;
    for (int i = 0; i < 400; ++i) {
        const Real middle = enters && low == 0 ? high / 16 : (low + high) / 2;
        (residual(middle) > 0 ? high : low) = middle;
        if (enters && high == 0) break;
    }
    const Real s = (low + high) / 2;
    if (enters) return {eta - s, potential(law, s) / (s - eta)};
    return {s, mean_force(law, eta, s)};
}

void agrees(const ContactLaw& law, double eta, double b, double theta, const ContactSolution& s) {
    const Truth truth = bisect(law, eta, b, theta);
    const auto where = ::testing::Message()
                       << "k " << law.k << " alpha " << law.alpha << " eta " << eta << " b " << b
                       << " theta " << theta << " r " << s.r << " for " << double(truth.r);
    ASSERT_TRUE(s.converged) << where;
    EXPECT_LE(std::abs(s.r - truth.r), 4e-15L * (std::abs(Real(b)) + std::abs(truth.r))) << where;
    EXPECT_LE(std::abs(s.force - truth.force), 2e-13L * truth.force + 1e-300L)
        << where << " force " << s.force << " for " << double(truth.force);
    EXPECT_LE(s.iterations, 9) << where;
}

const double exponents[] = {1.0, 1.1, 1.3, 1.5, 2.0, 2.5, 3.0};

TEST(Contact, AgreesWithBisectionInEveryCaseFromSoftToStiff) {
    std::mt19937_64 random(20160905);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto decade = [&](double low, double high) {
        return std::pow(10, low + (high - low) * unit(random));
    };
    long iterations = 0, solves = 0;
    for (double alpha : exponents)
        for (int i = 0; i < 1500; ++i) {
            const ContactLaw law{decade(2, 16), alpha};
            const double theta = decade(-13, -5);
            const double eta = (unit(random) < 0.5 ? -1 : 1) * decade(-12, -3);
            const double b = (unit(random) < 0.5 ? -1 : 1) * decade(-12, -3);
            const auto s = solve_power_contact(law, eta, b, theta);
            agrees(law, eta, b, theta, s);
            if (alpha == 1) agrees(law, eta, b, theta, solve_linear_contact(law.k, eta, b, theta));
            iterations += s.iterations;
            solves += s.iterations > 0;
        }
    EXPECT_LT(iterations, 5 * solves);
    RecordProperty("mean_iterations", std::to_string(double(iterations) / double(solves)));
}

TEST(Contact, TheLimitOfNoIncrementIsTheStaticForce) {
    for (double alpha : exponents)
        for (double k : {1e2, 1e6, 1e10, 1e13, 1e16})
            for (double eta : {1e-10, 1e-7, 1e-4}) {
                const ContactLaw law{k, alpha};
                const double theta = 1e-9, still = theta * law.force(eta);
                // r about -part still
                for (double part : {0.0, 1e-16, -1e-12, 1e-9, -1e-6, 1e-4}) {
                    const double b = still * (1 + part);
                    agrees(law, eta, b, theta, solve_power_contact(law, eta, b, theta));
                    agrees(law, eta, b, theta, solve_contact(law, eta, b, theta));
                }
                EXPECT_NEAR(solve_contact(law, eta, still, theta).force / law.force(eta), 1, 1e-14);
            }
}

TEST(Contact, GrazingAndZeroPenetrationAreOrdinary) {
    for (double alpha : exponents)
        for (double k : {1e2, 1e9, 1e16}) {
            const ContactLaw law{k, alpha};
            for (double eta : {0.0, -1e-9, -1e-4}) {
                // ends exactly at the surface
                const auto touch = solve_contact(law, eta, -eta, 1e-9);
                EXPECT_EQ(touch.force, 0);
                EXPECT_EQ(touch.r, eta);
                for (double past : {1e-25, 1e-18, 1e-13})
                    agrees(law, eta, -eta + past, 1e-9, solve_contact(law, eta, -eta + past, 1e-9));
            }
            for (double b : {-1e-5, 1e-5, 1e-12, 1e-30})
                agrees(law, 0.0, b, 1e-9, solve_contact(law, 0.0, b, 1e-9));
            for (double b : {-1e-5, 0.0, 1e-5, 1e-12})
                agrees(law, 1e-25, b, 1e-9, solve_contact(law, 1e-25, b, 1e-9));
            EXPECT_EQ(solve_contact(law, 0.0, 0.0, 1e-9).r, 0);
        }
}

TEST(Contact, LeavingAndStayingMeetWhereTheStringEndsAtTheSurface) {
    for (double alpha : exponents) {
        const ContactLaw law{1e11, alpha};
        const double theta = 1e-9, eta = 1e-7;
        const double b = theta * law.potential(eta) / eta - eta;  // r = eta
        for (double nudge : {-1e-13, -1e-16, 0.0, 1e-16, 1e-13})
            agrees(law, eta, b * (1 + nudge), theta,
                   solve_contact(law, eta, b * (1 + nudge), theta));
    }
}

TEST(Contact, ForceTimesIncrementIsThePotentialGivenUp) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (double alpha : exponents)
        for (int i = 0; i < 300; ++i) {
            const ContactLaw law{1e12, alpha};
            const double eta = 2e-6 * unit(random) - 1e-6, b = 2e-6 * unit(random) - 1e-6;
            const auto s = solve_contact(law, eta, b, 1e-9);
            const Real before = potential(law, eta), after = potential(law, Real(eta) - s.r);
            EXPECT_NEAR(s.force * s.r, double(before - after), 1e-13 * double(before + after));
        }
}

TEST(Contact, HighExponentsAreSolvedToo) {  // where powers of a depth leave double's range as well
    std::mt19937_64 random(20260905);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto decade = [&](double low, double high) {
        return std::pow(10, low + (high - low) * unit(random));
    };
    for (double alpha : {5.0, 10.0, 20.0, 30.0, 50.0}) {
        const ContactLaw example{4.4e13, alpha};
        // eta^30 is no double, (b/eta)^31 neither
        const auto graze = solve_contact(example, 1.1e-12, 9.2e-3, 4e-5);
        ASSERT_TRUE(graze.converged) << alpha;
        EXPECT_NEAR(graze.r, double(bisect(example, 1.1e-12, 9.2e-3, 4e-5).r), 1e-15) << alpha;
        for (int i = 0; i < 300; ++i) {
            const ContactLaw law{decade(0, 60), alpha};
            const double theta = decade(-30, 0),
                         eta = (unit(random) < 0.5 ? -1 : 1) * decade(-30, 0),
                         b = (unit(random) < 0.5 ? -1 : 1) * decade(-30, 0);
            const auto s = solve_contact(law, eta, b, theta);
            const Truth truth = bisect(law, eta, b, theta);
            const auto where = ::testing::Message()
                               << "k " << law.k << " alpha " << alpha << " eta " << eta << " b "
                               << b << " theta " << theta << " r " << s.r << " for "
                               << double(truth.r);
            ASSERT_TRUE(s.converged && std::isfinite(s.force)) << where;
            // a power's rounding is that of its base as many times as the exponent says
            ASSERT_LE(std::abs(s.r - truth.r),
                      4e-16L * (10 + alpha) * (std::abs(Real(b)) + std::abs(truth.r)))
                << where;
            ASSERT_LE(s.iterations, 10 + 0.8 * alpha) << where;
        }
    }
}

TEST(Contact, WhatIsNotANumberDoesNotConverge) {
    const ContactLaw law{1e12, 1.3};
    EXPECT_FALSE(solve_power_contact(law, 1e-7, std::nan(""), 1e-9).converged);
    EXPECT_FALSE(solve_power_contact(law, std::nan(""), 1e-7, 1e-9).converged);
}

}  // namespace
}  // namespace jvari
