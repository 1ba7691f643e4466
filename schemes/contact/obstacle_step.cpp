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
    std::vector<double> reduced(n * n);
    for (int a = 0; a < n; ++a)
        for (int c = 0; c < n; ++c) reduced[a * n + c] = theta[a * stride + c] - coupling_[a] * s_ * inverse_ * coupling_[c];
    gram_ = ContactGram(laws_, reduced);
    for (auto* v : {&eta_, &b_, &r_}) v->assign(n, 0.0);
}

bool ObstacleStep::solve(const double* older, const double* free, double* force) noexcept {
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

double ObstacleStep::potential(const double* reading) const {
    double sum = 0;
    for (int a = 0; a < contacts_; ++a) sum += laws_[a].potential(heights_[a] - reading[a]);
    if (thread_) sum += 0.5 * stiffness_ * (reading[contacts_] - rest_) * (reading[contacts_] - rest_);
    return sum;
}

}  // namespace jvari
