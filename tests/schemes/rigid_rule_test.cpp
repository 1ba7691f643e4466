// Barriers that do not give way: the invariants of contact/rigid_rule.hpp over many steps, and that
// the discrete gradient tends to it.
#include "schemes/contact/rigid_rule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "schemes/contact/gradient_rule.hpp"
#include "schemes/contact/obstacle.hpp"
#include "tests/schemes/contact_points.hpp"

namespace jvari {
namespace {

constexpr int pushes = 400;

Points points_of(std::mt19937& random, int contacts, double k, bool thread) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Points p;
    for (int a = 0; a < contacts; ++a) p.contacts.add({k, 1}, -1e-5 * (1 + unit(random)), 0);
    if (thread) p.thread = Thread{0, 0, 1e5, 1.2, 1e-5};
    couple(p, random, 1e-3);
    return p;
}

// Points that are pushed about at random, towards their barriers more often than away. Calls
// each(step, y before, r, forces).
template <class Each>
void walk(Obstacle& obstacle, const Points& p, Each each) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const int n = p.count();
    std::vector<double> y(n, 0.0), free(n), force(n), r(n);
    obstacle.clear();
    obstacle.begin(y.data(), y.data(), y.data());  // at rest
    for (int step = 0; step < pushes; ++step) {
        for (int k = 0; k < n; ++k) free[k] = 3e-6 * (unit(random) - 0.3) - 0.02 * y[k];
        ASSERT_TRUE(obstacle.solve({y.data(), y.data(), free.data()}, force.data())) << step;
        for (int k = 0; k < n; ++k) {
            r[k] = free[k];
            for (int m = 0; m < n; ++m) r[k] += p.theta[k * n + m] * force[m];
        }
        each(step, y, r, force);
        for (int k = 0; k < n; ++k) y[k] += r[k];
    }
}

TEST(RigidRule, ItGivesBackAllThatItTakesNeverPullsAndLetsNothingThrough) {
    for (const bool threaded : {false, true})
        for (const int contacts : {1, many}) {
            std::mt19937 random(3);
            const Points p = points_of(random, contacts, rigid, threaded);
            Obstacle obstacle(p.contacts, p.threads(), p.theta, span, 1, rule_with<RigidRule>({}));
            int strikes = 0, throws_back = 0;
            // no wall is touched yet
            double before =
                threaded ? 0.5 * p.thread->stiffness * p.thread->height * p.thread->height : 0;
            walk(obstacle, p, [&](int step, const auto& y, const auto& r, const auto& force) {
                double work = 0, after_y[many + 1], size = 0;
                for (int k = 0; k < p.count(); ++k) {
                    work += force[k] * r[k];
                    size += std::abs(force[k] * r[k]);
                    after_y[k] = y[k] + r[k];
                }
                const double after = obstacle.potential(after_y);
                const double lost = span * obstacle.loss();
                EXPECT_NEAR(work, before - after - lost, 1e-12 * (size + before + after)) << step;
                before = after;
                for (int a = 0; a < contacts; ++a) {
                    EXPECT_GE(force[a], 0) << step;
                    EXPECT_GE(after_y[a] - p.contacts.heights[a], -1e-12 * 1e-5)
                        << step << " penetrates";
                    if (force[a] > 0) ++(r[a] > 1e-14 ? throws_back : strikes);
                }
            });
            EXPECT_GT(strikes, 10);
            EXPECT_GT(throws_back, 10);
        }
}

// A spring of stiffness k is penetrated by sqrt(2V/k): a hundred times the stiffness makes a tenth
// of the difference.
TEST(RigidRule, IsWhatTheDiscreteGradientTendsToAsTheBarrierStiffens) {
    for (const int contacts : {1, many}) {
        std::vector<double> rigid_motion;
        const auto motion = [&](auto* rule, double k) {
            std::mt19937 random(3);
            const Points p = points_of(random, contacts, k, true);
            Obstacle obstacle(p.contacts, p.threads(), p.theta, span, 1,
                              rule_with<std::remove_pointer_t<decltype(rule)>>({}));
            std::vector<double> all;
            walk(obstacle, p, [&](int step, const auto& y, const auto&, const auto&) {
                if (step < 60) all.insert(all.end(), y.begin(), y.end());
            });
            return all;
        };
        const auto limit = motion(static_cast<RigidRule*>(nullptr), rigid);
        const auto away = [&](double k) {
            const auto penalty = motion(static_cast<GradientRule*>(nullptr), k);
            double largest = 0;
            for (std::size_t i = 0; i < limit.size(); ++i)
                largest = std::max(largest, std::abs(penalty[i] - limit[i]));
            return largest;
        };
        const double soft = away(1e11), stiff = away(1e13);
        EXPECT_GT(soft, 1e-12) << "nothing was touched";
        EXPECT_LT(soft, 1e-6);
        EXPECT_NEAR(soft / stiff, 10, 4) << soft << " " << stiff;
    }
}

}  // namespace
}  // namespace jvari
