// Source: van Walstijn, Bridges & Mehes 2016, eqs 44-48, for any number of contacts and either number of time levels.
#include "schemes/contact/obstacle_step.hpp"

#include <algorithm>

namespace jvari {

ObstacleStep::ObstacleStep(std::span<const ContactLaw> laws, std::span<const double> heights, const std::optional<Thread>& thread,
                           std::span<const double> theta, double span)
    : contacts_(static_cast<int>(laws.size())),
      thread_(thread.has_value()),
      laws_(laws.begin(), laws.end()),
      heights_(heights.begin(), heights.end()),
      span_(span) {
    const int n = contacts_, stride = points();
    coupling_.assign(n, 0.0);
    if (thread) {
        stiffness_ = thread->stiffness;
        damping_ = thread->damping;
        rest_ = thread->height;
        s_ = 0.5 * stiffness_ + damping_ / span;
        theta_cc_ = theta[n * stride + n];
        inverse_ = 1 / (1 + s_ * theta_cc_);
        for (int a = 0; a < n; ++a) coupling_[a] = theta[a * stride + n];
    }
    if (n > 0) theta_bb_ = theta[0];
    std::vector<double> reduced(n * n);
    for (int a = 0; a < n; ++a)
        for (int c = 0; c < n; ++c) reduced[a * n + c] = theta[a * stride + c] - coupling_[a] * s_ * inverse_ * coupling_[c];
    gram_ = ContactGram(laws_, reduced);
    for (auto* v : {&eta_, &b_, &r_}) v->assign(n, 0.0);
}

bool ObstacleStep::solve(const double* older, const double* free, double* force) noexcept {
    if (series_) return solve_in_series(older, free, force);
    const int n = contacts_;
    double thread = 0;  // with no contact force
    if (thread_) thread = -(s_ * free[n] + stiffness_ * (older[n] - rest_)) * inverse_;
    bool touching = false;
    for (int a = 0; a < n; ++a) {
        eta_[a] = heights_[a] - older[a];
        b_[a] = -free[a] - coupling_[a] * thread;
        touching = touching || eta_[a] > 0 || eta_[a] + b_[a] > 0;
    }
    bool converged = true;
    if (touching) {
        const GramSolution s = gram_.solve(eta_.data(), b_.data(), r_.data(), force);
        converged = s.converged;
        for (int a = 0; a < n; ++a) {
            thread -= s_ * inverse_ * coupling_[a] * force[a];
            tally_.smallest_force = std::min(tally_.smallest_force, force[a]);
            tally_.deepest = std::max(tally_.deepest, eta_[a] - r_[a]);
        }
        ++tally_.solves;
        tally_.iterations += s.iterations;
        tally_.most_iterations = std::max(tally_.most_iterations, s.iterations);
        tally_.residual = std::max(tally_.residual, s.residual);
    } else {
        for (int a = 0; a < n; ++a) force[a] = 0;
    }
    if (thread_) force[n] = thread;
    return converged;
}

double ObstacleStep::potential(const double* reading, int level) const {
    if (series_) return series_->points.energy(contacts_ ? reading[0] : 0, thread_ ? reading[contacts_] : 0, Y_[level]);
    double sum = 0;
    for (int a = 0; a < contacts_; ++a) sum += laws_[a].potential(heights_[a] - reading[a]);
    if (thread_) sum += 0.5 * stiffness_ * (reading[contacts_] - rest_) * (reading[contacts_] - rest_);
    return sum;
}

void ObstacleStep::put_in_series(const MissingCompliance& C, int levels) {
    const SeriesPoints points(contacts_ ? &laws_[0] : nullptr, contacts_ ? heights_[0] : 0, stiffness_, damping_, rest_, C);
    series_ = SeriesStep(points, theta_bb_, contacts_ && thread_ ? coupling_[0] : 0, theta_cc_, span_);
    levels_ = levels;
}

void ObstacleStep::begin(const double* reading) {
    if (series_ && thread_) Y_[0] = Y_[1] = begun_ = series_->start(reading[contacts_]);
}

void ObstacleStep::follow(const ObstacleStep& first) {
    Y_[0] = first.begun_;
    Y_[1] = first.Y_[0];
}

SeriesPoints::Forces ObstacleStep::forces(const double* reading, int level) const {
    if (!series_) return {};
    return series_->points.forces(contacts_ ? reading[0] : 0, thread_ ? reading[contacts_] : 0, Y_[level]);
}

bool ObstacleStep::solve_in_series(const double* older, const double* free, double* force) noexcept {
    const SeriesStep& s = *series_;
    const int c = contacts_;
    const double y_b = c ? older[0] : 0, u_b = c ? free[0] : 0, y_c = thread_ ? older[c] : 0, u_c = thread_ ? free[c] : 0, Y = Y_[0];
    const double v = thread_ ? s.pull(s.points.stretch(y_c, Y), u_c, Y) : 0;
    ContactSolution x;
    if (c) {
        const double zeta = s.points.approach(y_b, y_c, Y), b = s.approach(u_b, u_c, v, Y);
        const SeriesLaw& law = s.points.law;
        x = law.law.alpha == 1 ? solve_linear_contact(law.both, zeta, b, s.theta) : solve_series_contact(law, zeta, b, s.theta);
        force[0] = x.force;
        if (x.force > 0 || zeta > 0) {
            tally_.smallest_force = std::min(tally_.smallest_force, x.force);
            tally_.deepest = std::max(tally_.deepest, law.depth(zeta - x.r));
            ++tally_.solves;
            tally_.iterations += x.iterations;
            tally_.most_iterations = std::max(tally_.most_iterations, x.iterations);
            tally_.residual = std::max(tally_.residual, x.residual);
        }
    }
    if (thread_) {
        force[c] = v - s.beta * x.force;
        moved_ = s.moved(force[c], Y);
    }
    Y_[0] = levels_ == 2 ? Y_[1] : Y + moved_;
    Y_[1] = Y + moved_;
    return x.converged;
}

}  // namespace jvari
