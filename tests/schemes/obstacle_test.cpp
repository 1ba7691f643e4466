// What surrounds an obstacle rule: whatever the rule, the thread and the losses, the work on the
// string is what the potentials lose less what is dissipated, over steps of random points (the
// invariant of contact/obstacle_rule.hpp).
#include "schemes/contact/obstacle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "schemes/contact/explicit_rule.hpp"
#include "schemes/contact/gradient_rule.hpp"
#include "schemes/contact/quadratised_rule.hpp"
#include "tests/schemes/contact_points.hpp"

namespace jvari {
namespace {

Points points_of(std::mt19937& random, bool thread, double beta,
                 LossLaw by = LossLaw::hunt_crossley) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Points p;
    for (int a = 0; a < many; ++a)
        p.contacts.add({std::pow(10, 7 + unit(random)), 1 + 0.5 * (a % 2)}, 1e-4 * unit(random),
                       beta, by);
    if (thread) p.thread = Thread{0, 0, 1e5, 1.2, 1e-5};
    couple(p, random, 1e-4);
    return p;
}

// psi, left behind
template <class Rule>
constexpr bool obstacle_may_pull = std::is_same_v<Rule, QuadratisedRule<Quadratisation::raw>>;

template <class Rule>
void balances(int levels, bool threaded, double beta, LossLaw by = LossLaw::hunt_crossley) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    int touched = 0;
    for (int draw = 0; draw < 200; ++draw) {
        const Points p = points_of(random, threaded, beta, by);
        const int n = p.count();
        Obstacle obstacle(p.contacts, p.threads(), p.theta, span, levels, rule_with<Rule>({}));
        const std::vector<double> nothing(n, 0.0);
        std::vector<double> older(n), now(n), free(n), force(n), newer(n);
        for (int k = 0; k < n; ++k) {
            older[k] = 1e-4 * unit(random);
            free[k] = 1e-4 * unit(random);
            now[k] = levels == 1 ? older[k] : older[k] + 0.5 * free[k];
        }
        obstacle.begin(older.data(), nothing.data(), nothing.data());
        const double before = obstacle.potential(older.data());
        ASSERT_TRUE(obstacle.solve({older.data(), now.data(), free.data()}, force.data()));
        double work = 0;
        for (int k = 0; k < n; ++k) {
            newer[k] = older[k] + free[k];
            for (int m = 0; m < n; ++m) newer[k] += p.theta[k * n + m] * force[m];
            const double moved = newer[k] - older[k];
            // of three-point steps psi has half the weight of the thread's two levels
            work += force[k] * moved * (levels == 2 && k < many && obstacle.dofs() > 0 ? 0.5 : 1);
        }
        double lost = span * obstacle.loss();
        if (levels == 2 && obstacle.dofs() > 0) {  // psi's share of the losses likewise
            const double of_thread =
                threaded ? p.thread->damping * std::pow(newer.back() - older.back(), 2) / span : 0;
            lost = of_thread + 0.5 * (lost - of_thread);
        }
        const double after = obstacle.potential(newer.data());
        EXPECT_NEAR(work, before - after - lost, 1e-12 * (before + after + std::abs(work) + lost))
            << draw;
        EXPECT_GE(obstacle.loss(), 0);
        for (int a = 0; a < many; ++a) {
            touched += force[a] != 0;
            const bool by_law =
                by == LossLaw::hunt_crossley && beta * (newer[a] - older[a]) >= span * (1 - 1e-9);
            if (!by_law && !obstacle_may_pull<Rule>) { EXPECT_GE(force[a], 0); }
        }
    }
    EXPECT_GT(touched, 100) << "nothing was tested";
}

template <class Rule>
class Conserving : public testing::Test {};
using Rules = testing::Types<GradientRule, QuadratisedRule<Quadratisation::released>,
                             QuadratisedRule<Quadratisation::raw>>;
TYPED_TEST_SUITE(Conserving, Rules, );

TYPED_TEST(Conserving, TheWorkOnTheStringIsWhatThePotentialsLoseLessTheLosses) {
    for (const int levels : {1, 2})
        for (const bool threaded : {false, true})
            for (const double beta : {0.0, 0.1, 0.5, 20.0})
                balances<TypeParam>(levels, threaded, beta);
}
TEST(Clipped, LossesBalanceWithoutPull) {
    for (const int levels : {1, 2})
        for (const double beta : {0.1, 0.5, 20.0})
            balances<GradientRule>(levels, true, beta, LossLaw::clipped);
}

TEST(Obstacle, ATautThreadStartsByItsForceAtTheNewerLevel) {  // u- = u+: k (h - (u+ + u-)/2)
    std::mt19937 random(4);
    const Points p = points_of(random, true, 0);
    const int n = p.count();
    std::vector<double> half = p.theta;
    for (double& theta : half) theta *= 0.5;
    Obstacle start =
        Obstacle(p.contacts, p.threads(), p.theta, span, 2, rule_with<GradientRule>({}))
            .halved(ThreadStart::taut, half, nullptr);
    const std::vector<double> older(n, 2e-4), free(n, -3e-4);
    std::vector<double> force(n);
    const std::vector<double> nothing(n, 0.0);
    start.begin(older.data(), nothing.data(), nothing.data());
    ASSERT_TRUE(start.start({older.data(), older.data(), free.data()}, force.data()));
    double newer = older.back() + free.back();
    for (int m = 0; m < n; ++m) newer += 0.5 * p.theta[(n - 1) * n + m] * force[m];
    EXPECT_NEAR(force.back(), p.thread->stiffness * (p.thread->height - newer),
                1e-9 * std::abs(force.back()));
    EXPECT_GT(force.front() + force[1] + force[2], 0) << "no contact";
}

TEST(Obstacle, OneContactInClosedFormIsOneOfSeveral) {  // beside one that is never touched
    const double theta = 1e-6, apart[] = {theta, 0, 0, theta}, older[] = {-1e-5, 1},
                 free[] = {1.5e-5, 0}, nothing[2] = {};
    Contacts one, two;
    one.add({1e8, 1.5}, 0, 0);
    two.add(one, 0);
    two.add({1e8, 1}, 0, 0);
    const auto force = [&]<class Rule>(Rule*, const Contacts& contacts,
                                       std::span<const double> compliances) {
        Obstacle obstacle(contacts, {}, compliances, span, 1, rule_with<Rule>({}));
        obstacle.begin(older, nothing, nothing);
        double F[2] = {};
        EXPECT_TRUE(obstacle.solve({older, older, free}, F));
        return F[0];
    };
    const auto agree = [&](auto* rule) {
        const double alone = force(rule, one, std::span(&theta, 1)),
                     among = force(rule, two, apart);
        EXPECT_NE(alone, 0);
        EXPECT_NEAR(among, alone, 1e-9 * std::abs(alone));
    };
    agree(static_cast<GradientRule*>(nullptr));
    agree(static_cast<ExplicitRule*>(nullptr));
    agree(static_cast<QuadratisedRule<Quadratisation::released>*>(nullptr));
    agree(static_cast<QuadratisedRule<Quadratisation::raw>*>(nullptr));
}

}  // namespace
}  // namespace jvari
