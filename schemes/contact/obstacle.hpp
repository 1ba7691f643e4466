// One step of a string's contacts and thread, given what every string has at hand: the reading of
// each point at the older level, the force-free increment of each reading over the step, and the
// compliances between the points.
//
//     r = free + Theta F;   contacts: by an obstacle rule, of eta = h - reading (obstacle_rule.hpp)
//                           thread:   F_c = -k_c (older_c + r_c/2 - h_c) - r_c (damping)/span
//
// span is the time between the older and the newer level: dt in two-point schemes (van Walstijn et
// al. 2016, eqs 44-48), 2 dt in three-point ones, where the thread so sees the mean of the two
// outer levels and stays stable at any stiffness. The thread is eliminated (eliminated_thread.hpp).
//
// Where contacts lose energy (Hunt-Crossley, Issanchou et al. 2016, eq 24), each pulls by D_a r_a
// more, D_a = beta_a V_a'(eta_a^n)/span: known before the step, and never negative. Then r = (I +
// Theta D)^-1 (free + Theta F) is the same equation with other compliances, solved so only while a
// lossy contact is closed. It takes sum D_a r_a^2.
//
// What the string lacks at its points stands in series with them (compliance.hpp): a compliance C,
// beside it a ladder. It moves by D, and by the rule at midpoints F = P + (D+ - D)/2 C^-1 + R (D+ -
// D)/span - B v with P = C^-1 D the force of the spring, v the velocities of the ladder's masses, R
// and B what all of it and its branch with the mass resist in a step. So with Q = P - B v, W = (R
// C/span + 1/2)^-1 and K = C W,
//     D+ = D + K (F - Q),   P+ = P + W (F - Q),   points at reading + C P,   r = free - K Q +
//                           (Theta + K) F,
// the equation above with Theta + K for Theta. (P' C P + v' M v)/2 is stored, and what MassStep
// says is lost.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/contact/contact_loss.hpp"
#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/contact/obstacle_rule.hpp"
#include "schemes/contact/residual.hpp"

namespace jvari {

struct ReadingsBeforeStep {  // of each point [m]
    const double* older;
    // of the level that the step is centred on: two-point steps have the older one here
    const double* now;
    const double* free;  // increment from the older to the newer level without the points' forces
};

// How a three-point scheme starts its thread from rest: by its own equation, in which the outer
// levels are one, or by that of a two-point step from level 0 to level 1.
enum class ThreadStart { taut, plain };

template <ObstacleRule Rule>
class Obstacle {
public:
    Obstacle() = default;
    // theta [m/N]: row-major over the points, the contacts first and then the threads. levels: that
    // a step spans.
    Obstacle(const Contacts& contacts, std::vector<Thread> threads, std::span<const double> theta,
             double span, int levels)
        : contacts_(contacts),
          threads_(std::move(threads), contacts.count(), theta, span),
          rule_(contacts.laws, threads_.between_contacts(theta), levels),
          loss_(contacts, threads_.between_contacts(theta), span),
          theta_(theta.begin(), theta.end()),
          span_(span),
          levels_(levels) {
        for (auto* v : {&eta_, &now_, &b_, &r_}) v->assign(contacts.count(), 0.0);
        for (auto* v : {&pull_, &from_}) v->assign(threads_.count(), 0.0);
        one_ = threads_.count() <= 1 &&
               (contacts.count() == 0 || (contacts.count() == 1 && contacts.loss[0] == 0));
        threaded_ = threads_.count() > 0;
    }

    // The first half step of a three-point scheme, from rest: its own compliances, half the span,
    // no contact loss.
    Obstacle halved(ThreadStart how, std::span<const double> theta) const {
        Contacts elastic = contacts_;
        std::fill(elastic.loss.begin(), elastic.loss.end(), 0.0);
        std::vector<Thread> threads = threads_.laws();
        for (Thread& thread : threads)
            // so that phi = k
            if (how == ThreadStart::taut) thread.damping = 0.25 * thread.stiffness * span_;
        return {elastic, threads, theta, 0.5 * span_, levels_};
    }
    // levels: how many of them a step spans
    void put_in_series(const MissingMatrix& missing, int levels) {
        Series z(Residual(missing, span_));
        std::vector<double> theta = theta_;
        for (std::size_t i = 0; i < theta.size(); ++i) theta[i] += z.K[i];
        *this = Obstacle(Contacts(contacts_), std::vector(threads_.laws()), theta, span_, levels_);
        z.rate = 1 / span_;
        series_levels_ = levels;
        for (auto* v : {&z.P[0], &z.P[1], &z.v[0], &z.v[1], &z.older, &z.now, &z.free, &z.q})
            v->assign(z.points, 0.0);
        series_ = std::move(z);
    }

    int contacts() const { return contacts_.count(); }
    int points() const { return contacts() + threads_.count(); }
    int dofs() const { return rule_.dofs(); }
    const Rule& rule() const { return rule_; }
    Rule& rule() { return rule_; }

    void clear() { tally_ = {}; }
    void begin(const double* reading) {  // at rest at t = 0
        for (int a = 0; a < contacts(); ++a) eta_[a] = contacts_.heights[a] - reading[a];
        rule_.begin(eta_.data());
        if (series_) series_->rest();
    }
    // of a step; without thread, contact loss and series
    void set(std::span<const double> theta) noexcept { rule_.set(theta); }
    // after `first` made the first half step
    void follow(const Obstacle& first) {
        // with its state, and other compliances
        rule_ = first.rule_;
        rule_.set(loss_.undamped());
        tally_ = first.tally_;
        if (!series_) return;
        series_->rest();
        series_->P[1] = first.series_->P[0];
        series_->v[1] = first.series_->v[0];
    }

    // Forces on the string [N] out, one per point. False where the contacts did not converge.
    // Allocates nothing.
    bool solve(const ReadingsBeforeStep& at, double* force) noexcept {
        lost_by_rule_ = 0;
        if (!series_) return solve_touching(at, force);
        return points() == 1   ? solve_in_series<1>(at, force)
               : points() == 2 ? solve_in_series<2>(at, force)
                               : solve_in_series<0>(at, force);
    }
    bool start(const ReadingsBeforeStep& at, double* force) noexcept {
        return series_ ? solve(at, force) : solve_points<true>(at, force);
    }

    // At the readings of one level [J]; level: 0 the one that the next step starts from, 1 the one
    // after it (with something in series).
    double potential(const double* reading, int level = 0) const {
        const double* P = series_ ? series_->P[level].data() : nullptr;
        double sum = series_ ? series_->stored(P, series_->v[level].data()) : 0;
        const auto at = [&](int a) { return reading[a] + (series_ ? series_->yield(a, P) : 0); };
        for (int a = 0; a < contacts(); ++a)
            sum += rule_.potential(a, contacts_.heights[a] - at(a));
        for (int t = 0; t < threads_.count(); ++t) sum += threads_.stored(t, at(contacts() + t));
        return sum;
    }
    // of the last step [W]: of threads, of lossy contacts, of what is in series, of the rule
    double loss() const {
        double power = ((series_ ? series_->lost : 0) + loss_.lost()) / span_;
        power += levels_ * lost_by_rule_ / span_;
        for (int t = 0; t < threads_.count(); ++t)
            power += threads_.lost(t, threads_.moved(t, from_[t], pull_[t]));
        return power;
    }
    // of each point at that level, of what is in series
    void forces(int level, double* force) const {
        if (series_) std::copy(series_->P[level].begin(), series_->P[level].end(), force);
    }

    std::vector<Fact> facts() const {
        std::vector<Fact> f = {{facts::contact_points, static_cast<double>(contacts())},
                               {facts::smallest_contact_force, tally_.force.least},
                               {facts::largest_contact_force, tally_.force.most},
                               {facts::deepest_penetration, tally_.deepest}};
        if constexpr (Rule::iterates) {
            f.push_back({facts::contact_solves, static_cast<double>(tally_.solves)});
            f.push_back({facts::contact_iterations_mean,
                         tally_.solves > 0 ? static_cast<double>(tally_.iterations) /
                                                 static_cast<double>(tally_.solves)
                                           : 0});
            f.push_back(
                {facts::contact_iterations_most, static_cast<double>(tally_.most_iterations)});
            f.push_back({facts::contact_residual, tally_.residual});
        }
        for (Fact& fact : rule_.facts()) f.push_back(std::move(fact));
        return f;
    }

private:
    // eta of a contact at the level that the step is centred on, as its rule has it
    // (obstacle_rule.hpp). thread: what the first pulls.
    double centre(int a, const ReadingsBeforeStep& at, double b, double thread) const {
        const double now = contacts_.heights[a] - at.now[a];
        if constexpr (!Rule::centred) return now;
        if (!series_) return levels_ == 1 ? now + 0.5 * b : now;
        if (!threaded_) return now;
        const double K = series_->K[a * series_->points + contacts()];
        return now - (K + 0.5 * (threads_.coupling(a, 0) - K)) * thread;
    }

    // One contact at most, which loses nothing, and a thread at most: the rule's closed form,
    // without a detour by way of memory.
    bool solve_one(const ReadingsBeforeStep& at, double* force) noexcept {
        const EliminatedThreads::One& t = threads_.one();
        const int n = contacts_.count();
        double thread = threaded_ ? t.alone(at.older[n], at.free[n]) : 0;
        bool converged = true;
        if (n == 1) {
            const double eta = contacts_.heights[0] - at.older[0],
                         b = -at.free[0] - t.coupling * thread, now = centre(0, at, b, thread);
            const BeforeStep before{&eta, &now, &b};
            force[0] = 0;
            if (rule_.acts(before)) {
                double r = 0;
                const GramSolution s = rule_.solve(before, &r, force);
                tally_.force.note(force[0]);
                tally_.deepest =
                    std::max({tally_.deepest, contacts_.heights[0] - at.now[0], eta - r});
                note(s);
                converged = s.converged;
            }
            thread -= t.answer * force[0];
        }
        if (threaded_) pull(0, at, thread, force);
        return converged;
    }
    void pull(int t, const ReadingsBeforeStep& at, double F, double* force) noexcept {
        const int p = contacts() + t;
        force[p] = F;
        from_[t] = at.older[p], pull_[t] = F;
    }

    bool solve_touching(const ReadingsBeforeStep& at, double* force) noexcept {
        return one_ ? solve_one(at, force) : solve_points<false>(at, force);
    }
    template <bool at_start>
    bool solve_points(const ReadingsBeforeStep& at, double* force) noexcept {
        const int n = contacts(), m = threads_.count();
        threads_.alone(at.older, at.free, pull_.data());
        for (int a = 0; a < n; ++a) {
            eta_[a] = contacts_.heights[a] - at.older[a];
            b_[a] = -at.free[a];
            for (int t = 0; t < m; ++t) b_[a] -= threads_.coupling(a, t) * pull_[t];
            now_[a] = centre(a, at, b_[a], m > 0 ? pull_[0] : 0);
        }
        const BeforeStep before{eta_.data(), now_.data(), b_.data()};
        bool converged = true;
        const bool damped = loss_.damp(before, b_.data());
        if (damped || rule_.acts(before)) {
            if (damped) rule_.set(loss_.damped());
            GramSolution s;
            if constexpr (at_start && requires { rule_.start(before, force, force); })
                s = rule_.start(before, r_.data(), force);
            else s = rule_.solve(before, r_.data(), force);
            converged = s.converged;
            if (damped) {
                loss_.settle(r_.data(), force);
                rule_.set(loss_.undamped());
            }
            for (int a = 0; a < n; ++a) {
                for (int t = 0; t < m; ++t) pull_[t] -= threads_.answer(t, a) * force[a];
                tally_.force.note(force[a]);
                tally_.deepest =
                    std::max({tally_.deepest, contacts_.heights[a] - at.now[a], eta_[a] - r_[a]});
            }
            note(s);
        } else {
            for (int a = 0; a < n; ++a) force[a] = 0;
        }
        for (int t = 0; t < m; ++t) pull(t, at, pull_[t], force);
        return converged;
    }

    void note(const GramSolution& s) noexcept {
        if constexpr (requires { rule_.lost(); }) lost_by_rule_ = rule_.lost();
        ++tally_.solves;
        tally_.iterations += s.iterations;
        tally_.most_iterations = std::max(tally_.most_iterations, s.iterations);
        tally_.residual = std::max(tally_.residual, s.residual);
    }

    // A number for each point: in registers where there are `few` (1 or 2), in the vector that it
    // is given where `few` is 0.
    template <std::size_t few>
    class Numbers {
    public:
        explicit Numbers(std::vector<double>& many) : many_(many.data()) {}
        double* data() { return few > 0 ? few_.data() : many_; }
        double& operator[](std::size_t a) { return data()[a]; }

    private:
        std::array<double, std::max<std::size_t>(few, 1)> few_{};
        double* many_;
    };

    template <std::size_t few>
    bool solve_in_series(const ReadingsBeforeStep& at, double* force) noexcept {
        Series& z = *series_;
        const std::size_t n = few > 0 ? few : z.points;
        double *P = z.P[0].data(), *v = z.v[0].data();
        const double* P_now = z.P[series_levels_ - 1].data();
        Numbers<few> older(z.older), now(z.now), free(z.free), q(z.q);
        for (std::size_t a = 0; a < n; ++a) {
            older[a] = at.older[a] + Residual::times(z.C, a, P, n);
            now[a] = series_levels_ == 1 ? older[a] : at.now[a] + Residual::times(z.C, a, P_now, n);
            q[a] = P[a] - z.pulled(a, v, n);
        }
        for (std::size_t a = 0; a < n; ++a)
            free[a] = at.free[a] - Residual::times(z.K, a, q.data(), n);
        const bool converged = solve_touching({older.data(), now.data(), free.data()}, force);
        for (std::size_t a = 0; a < n; ++a) q[a] = force[a] - q[a];
        Numbers<few>& moved = free;
        for (std::size_t a = 0; a < n; ++a) {
            moved[a] = Residual::times(z.K, a, q.data(), n);
            P[a] += Residual::times(z.W, a, q.data(), n);
        }
        z.lost = z.damped(moved.data(), n) * z.rate;
        for (std::size_t k = 0; k < n; ++k) {
            const double along = Residual::times(z.V, k, moved.data(), n);
            z.lost += z.masses[k].lost(along, v[k]);
            z.masses[k].follow(along, v[k]);
        }
        if (series_levels_ == 2) z.P[0].swap(z.P[1]), z.v[0].swap(z.v[1]);
        return converged;
    }

    struct Tally {  // over the solves since clear()
        ForceRange force;
        double deepest = 0, residual = 0;
        long solves = 0, iterations = 0;
        int most_iterations = 0;
    };
    struct Series : Residual {
        explicit Series(Residual r) : Residual(std::move(r)) {}
        // at the two levels, of points [N] and patterns [m/s]
        std::array<std::vector<double>, 2> P, v;
        std::vector<double> older, now, free;  // of the points where they touch [m]
        std::vector<double> q;                 // workspace [N]
        double rate = 1;                       // 1/span [1/s]
        double lost = 0;                       // in the last step [J]
        void rest() {
            for (auto* levels : {&P, &v})
                for (auto& x : *levels) std::fill(x.begin(), x.end(), 0.0);
        }
    };
    Contacts contacts_;
    EliminatedThreads threads_;
    Rule rule_ = Rule({}, {}, 1);
    ContactLoss loss_;
    std::vector<double> theta_;           // of all points [m/N]
    double span_ = 1, lost_by_rule_ = 0;  // in the last step [J]
    int levels_ = 1, series_levels_ = 1;
    bool one_ = false, threaded_ = false;
    std::optional<Series> series_;
    std::vector<double> eta_, now_, b_, r_;
    // of each thread in the last step: its force [N], the reading it started from [m]
    std::vector<double> pull_, from_;
    Tally tally_;
};

}  // namespace jvari
