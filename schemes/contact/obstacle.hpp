// Solves one step of a string's contacts and threads from quantities that every string has: each
// point's reading at the older level, the force-free increment of each reading over the step, and
// the compliances between the points.
//
//     r = free + Theta F;   contacts: by an obstacle rule, of eta = h - reading (obstacle_rule.hpp)
//                           threads:  F = k (h - reading - r/2) - (damping) r/span
//
//     symbol  meaning                                                        unit  equation
//     span    from the older to the newer level: dt in two-point schemes,    s     [000] 44-48
//             2 dt in three-point ones, where the thread so sees the mean
//             of the two outer levels and stays stable at any stiffness
//     F       of the threads, which are eliminated (eliminated_thread.hpp)   N     [000] 45-47
//     kappa_a beta_a/span of a contact that loses energy: its rule's force   1/m
//             times 1 - kappa_a r_a (StepLoss, contact.hpp)
//     D, P    stretch and force of the springs in series with the points     m, N  (4), (5)
//             (residual.hpp): they touch at reading + D, and r = free - H +
//     H, K    (Theta + K) F, the same equation                               m, m/N
//
// (4) and (5) are in docs/compliance-matching.md.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/contact/few_contacts.hpp"
#include "schemes/contact/obstacle_rule.hpp"
#include "schemes/contact/residual.hpp"

namespace jvari {

struct ReadingsBeforeStep {  // for each point [m]
    const double* older;
    // readings on the level at the step's centre: two-point steps have the older level here
    const double* now;
    const double* free;  // increment from the older to the newer level without the points' forces
};

// Way in which a three-point scheme starts its thread from rest: by its own equation, in which the
// outer levels coincide, or by the equation of a two-point step from level 0 to level 1.
enum class ThreadStart { taut, plain };

class Obstacle {
public:
    // theta [m/N]: row-major over the points, the contacts first and then the threads. levels:
    // number of levels that a step spans. series: compliance in series with the points, or nullptr.
    Obstacle(const Contacts&, std::vector<Thread>, std::span<const double> theta, double span,
             int levels, const MakeRule&, const MissingMatrix* series = nullptr);
    // Copy for the first half step of a three-point scheme, from rest: separate compliances, half
    // the span, no contact loss. Both share one rule, whose state continues.
    Obstacle halved(ThreadStart how, std::span<const double> theta,
                    const MissingMatrix* series) const;

    int contacts() const { return contacts_.count(); }
    int points() const { return contacts() + threads_.count(); }
    int dofs() const { return rule_->dofs(); }

    void clear() { one_.tally = {}; }
    // at t = 0: reading, distance that each point's speed would move it in dt [m], and each force
    // on a string in equilibrium [N]
    void begin(const double* reading, const double* moving, const double* force);
    // Sets the step's theta; requires no thread, contact loss or series compliance.
    void set(std::span<const double> theta) noexcept;
    void follow(const Obstacle& first);  // after `first` made the first half step
    // Tests whether start_from() can copy the series state: both have equally many points.
    bool is_like(const Obstacle& other) const {
        return contacts() == other.contacts() && points() == other.points() &&
               series_.has_value() == other.series_.has_value();
    }
    void start_from(const Obstacle& before) noexcept {
        if (series_) series_->start_from(*before.series_);
    }

    // Computes the forces on the string [N], one per point. False if the contacts did not converge.
    // Allocates nothing. in_full: moved() and lost_by() will be called.
    bool solve(const ReadingsBeforeStep& at, double* force, bool in_full = false) noexcept {
        if (series_) return solve_in_series(at, force, in_full);
        return fused_ && !in_full ? solve_one(at, force) : solve_points(at, force, false, in_full);
    }
    // For each contact in the last step, solved in full: its way including the series compliance
    // [m], and its loss while it pushed by a force [J]
    const double* moved() const { return r_.data(); }
    double lost_by(int a, double force) const { return -force * r_[a] / levels_ - gained_[a]; }
    bool start(const ReadingsBeforeStep& at, double* force) noexcept {
        return series_ ? solve(at, force) : solve_points(at, force, true, false);
    }

    // Energy at the readings of one level [J]; level: 0 for the start of the next step, 1 for the
    // level after it (with series compliance).
    double potential(const double* reading, int level = 0) const;
    // Loss in the last step [W]: by threads, lossy contacts, the series compliance and the rule
    double loss() const;
    const double* forces(int level) const { return series_->force(level); }  // in series [N]
    std::vector<Fact> facts() const;

    // Tells whether solve_few() takes these contacts, by the discrete gradient without losses: a
    // single contact, or up to FewContacts::most linear ones in two-point steps. There may be one
    // thread.
    bool few() const { return fused_ || few_.has_value(); }
    // Solves a step at the readings y, which include the yield of the series compliance, for points
    // that move by u without forces; for string kernels that make whole steps.
    template <int contacts, bool thread>
    [[gnu::always_inline]] bool solve_few(const double* y, const double* u, double* force) noexcept;
    Residual* series() { return series_ ? &*series_ : nullptr; }
    bool has_series() const { return series_.has_value(); }

private:
    Obstacle(const Contacts&, std::vector<Thread>, std::span<const double> theta, double span,
             int levels, int levels_of_series, const MakeRule&, const MissingMatrix* series);
    double centre(int a, const ReadingsBeforeStep&, double b, double thread) const;
    bool solve_one(const ReadingsBeforeStep& at, double* force) noexcept {
        const int c = contacts_.count();
        const double y_b = c > 0 ? at.older[0] : 0, now_b = c > 0 ? at.now[0] : 0,
                     u_b = c > 0 ? at.free[0] : 0;
        double F_b, F_c;
        bool converged = true;
        if (!one_.thread) converged = one_.solve<true, false>(y_b, now_b, u_b, 0, 0, F_b, F_c);
        else {
            converged =
                one_.contact
                    ? one_.solve<true, true>(y_b, now_b, u_b, at.older[c], at.free[c], F_b, F_c)
                    : one_.solve<false, true>(0, 0, 0, at.older[c], at.free[c], F_b, F_c);
            force[c] = pull_[0] = F_c;
            from_[0] = at.older[c];
        }
        if (c > 0) force[0] = F_b;
        return converged;
    }
    bool solve_points(const ReadingsBeforeStep&, double* force, bool at_start,
                      bool in_full) noexcept;
    // energy of the rule; a rule with a state returns its energy at the instant, whatever eta
    double held_by(int a, double eta) const {
        return rule_->potential(a, eta) / (rule_->dofs() > 0 ? 1 : levels_);
    }
    GramSolution solve_contacts(const BeforeStep&, double* force, bool at_start) noexcept;
    bool solve_in_series(const ReadingsBeforeStep&, double* force, bool in_full) noexcept;

    Contacts contacts_;
    EliminatedThreads threads_;
    std::shared_ptr<ObstacleRule> rule_;
    std::vector<double> theta_;       // between all points [m/N]
    std::vector<double> between_;     // the contacts, the threads yielding (48)
    double span_, lost_by_rule_ = 0;  // in the last step [J]
    int levels_;
    bool centred_ = false, fused_ = false;
    ContactAndThread one_;  // the tally covers all contacts
    std::optional<FewContacts> few_;
    std::optional<Residual> series_;
    std::vector<double> eta_, now_, b_, r_, gained_;
    std::vector<double> older_points_, now_points_, free_points_;  // with the series compliance [m]
    // for each thread in the last step: its force [N], the reading at its start [m]
    std::vector<double> pull_, from_;
};

template <int contacts, bool thread>
[[gnu::always_inline]] inline bool Obstacle::solve_few(const double* y, const double* u,
                                                       double* force) noexcept {
    constexpr int n = contacts;
    if constexpr (n <= 1) {
        double F_b = 0, F_c = 0;
        const double y_b = n == 1 ? y[0] : 0, u_b = n == 1 ? u[0] : 0;
        const bool converged = one_.solve<n == 1, thread>(y_b, y_b, u_b, thread ? y[n] : 0,
                                                          thread ? u[n] : 0, F_b, F_c);
        if constexpr (n == 1) force[0] = F_b;
        if constexpr (thread) force[n] = F_c;
        return converged;
    } else {
        const double v = thread ? one_.of_thread.alone(y[n], u[n]) : 0;
        double eta[n], b[n], r[n];
        bool touches = false;
        for (int a = 0; a < n; ++a) {
            eta[a] = contacts_.heights[a] - y[a];
            b[a] = -u[a];
            if (thread) b[a] -= threads_.coupling(a, 0) * v;
            touches = touches || eta[a] > 0 || eta[a] + b[a] > 0;
        }
        const int iterations = few_->solve<n>(eta, b, r, force);
        if (iterations < 0) return solve_points({y, y, u}, force, false, false);
        double pull = v;
        for (int a = 0; a < n; ++a) {
            if (thread) pull -= threads_.answer(0, a) * force[a];
            if (touches) one_.tally.note(force[a], std::max(eta[a], eta[a] - r[a]));
        }
        if (touches) one_.tally.note(iterations, 0);
        if constexpr (thread) force[n] = pull;
        return true;
    }
}

}  // namespace jvari
