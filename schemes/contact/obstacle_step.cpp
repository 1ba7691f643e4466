// Source: van Walstijn, Bridges & Mehes 2016, eqs 44-48, for any number of contacts and either number of time levels.
#include "schemes/contact/obstacle_step.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

ObstacleStep::ObstacleStep(std::span<const ContactLaw> laws, std::span<const double> heights, const std::optional<Thread>& thread,
                           std::span<const double> theta, double span)
    : contacts_(static_cast<int>(laws.size())),
      thread_(thread, contacts_, theta, span),
      gram_(laws, thread_.between_contacts(theta)),
      laws_(laws.begin(), laws.end()),
      heights_(heights.begin(), heights.end()),
      span_(span),
      theta_(theta.begin(), theta.end()) {
    for (auto* v : {&eta_, &b_, &r_}) v->assign(contacts_, 0.0);
}

void ObstacleStep::lose(std::span<const double> beta) {
    if (std::all_of(beta.begin(), beta.end(), [](double b) { return b == 0; })) return;
    const int n = contacts_;
    Lossy z;
    z.beta.assign(beta.begin(), beta.end());
    z.theta = thread_.between_contacts(theta_);
    z.damped = z.matrix = z.theta;
    z.across.resize(z.theta.size());
    z.drag.resize(n);
    z.root.resize(n);
    z.closed.resize(n);
    z.b.resize(n);
    z.off.resize(n);
    lossy_ = std::move(z);
}

// Theta and b of the contacts with D: with S = D^1/2 on the closed ones and M = I + S Theta S = L L', X = L^-1 S Theta,
// Theta - X' X and b - X' L^-1 S b. False where no lossy contact is closed.
bool ObstacleStep::damp() noexcept {
    Lossy& z = *lossy_;
    const int n = contacts_;
    int m = 0;
    z.b = b_;
    for (int a = 0; a < n; ++a) {
        z.drag[a] = z.beta[a] * laws_[a].force(eta_[a]) / span_;
        z.root[a] = std::sqrt(z.drag[a]);
        if (z.drag[a] > 0) z.closed[m++] = a;
    }
    if (m == 0) return false;
    for (int i = 0; i < m; ++i) {  // row by row: L, X and L^-1 S b (in r_, which the solution replaces)
        const int a = z.closed[i];
        double* row = z.matrix.data() + i * n;
        double* x = z.across.data() + i * n;
        for (int j = 0; j <= i; ++j) {
            const double* other = z.matrix.data() + j * n;
            double sum = z.root[a] * z.theta[a * n + z.closed[j]] * z.root[z.closed[j]] + (i == j);
            for (int l = 0; l < j; ++l) sum -= row[l] * other[l];
            row[j] = i == j ? std::sqrt(sum) : sum / other[j];
        }
        double b = z.root[a] * b_[a];
        for (int c = 0; c < n; ++c) x[c] = z.root[a] * z.theta[a * n + c];
        for (int l = 0; l < i; ++l) {
            b -= row[l] * r_[l];
            for (int c = 0; c < n; ++c) x[c] -= row[l] * z.across[l * n + c];
        }
        r_[i] = b / row[i];
        for (int c = 0; c < n; ++c) x[c] /= row[i];
    }
    for (int a = 0; a < n; ++a)
        for (int i = 0; i < m; ++i) b_[a] -= z.across[i * n + a] * r_[i];
    for (int a = 0; a < n; ++a)
        for (int c = 0; c < n; ++c) {
            double sum = z.theta[a * n + c];
            for (int i = 0; i < m; ++i) sum -= z.across[i * n + a] * z.across[i * n + c];
            z.damped[a * n + c] = sum;
        }
    gram_.set(z.damped);
    return true;
}

// The springs' forces become those on the string. Where D Theta >> 1, a contact that creeps, the two terms of F - D r nearly cancel and r
// is small beside b: what rounding then leaves of r = -b + Theta F is put right by changes of r that D alone resists, D dr = S M^-1 S off.
void ObstacleStep::settle(double* force) noexcept {
    Lossy& z = *lossy_;
    const int n = contacts_;
    int m = 0;
    for (int a = 0; a < n; ++a) {
        force[a] -= z.drag[a] * r_[a];
        m += z.drag[a] > 0;
    }
    const auto miss = [&](int a) {
        double sum = -z.b[a] - r_[a];
        for (int c = 0; c < n; ++c) sum += z.theta[a * n + c] * force[c];
        return sum;
    };
    for (int i = 0; i < m; ++i) {  // L^-1 S off
        double sum = z.root[z.closed[i]] * miss(z.closed[i]);
        for (int l = 0; l < i; ++l) sum -= z.matrix[i * n + l] * z.off[l];
        z.off[i] = sum / z.matrix[i * n + i];
    }
    for (int i = m; i-- > 0;) {
        double sum = z.off[i];
        for (int l = i + 1; l < m; ++l) sum -= z.matrix[l * n + i] * z.off[l];
        z.off[i] = sum / z.matrix[i * n + i];
    }
    for (int i = 0; i < m; ++i) {
        const double change = z.root[z.closed[i]] * z.off[i];
        force[z.closed[i]] -= change;
        r_[z.closed[i]] += change / z.drag[z.closed[i]];
    }
    for (int a = 0; a < n; ++a) z.lost += z.drag[a] * r_[a] * r_[a];
}

std::vector<Fact> ObstacleStep::facts() const {
    return {{facts::contact_points, static_cast<double>(contacts_)},
            {facts::coupled_contact_points, static_cast<double>(coupled())},
            {facts::smallest_contact_force, tally_.force.least},
            {facts::largest_contact_force, tally_.force.most},
            {facts::deepest_penetration, tally_.deepest},
            {facts::contact_iterations_mean,
             tally_.solves > 0 ? static_cast<double>(tally_.iterations) / static_cast<double>(tally_.solves) : 0},
            {facts::contact_iterations_most, static_cast<double>(tally_.most_iterations)},
            {facts::contact_residual, tally_.residual}};
}

bool ObstacleStep::solve(const double* older, const double* free, double* force) noexcept {
    return series_ ? solve_in_series(older, free, force) : solve_points(older, free, force);
}

bool ObstacleStep::solve_points(const double* older, const double* free, double* force) noexcept {
    const int n = contacts_;
    double thread = thread_.alone(older, free);
    bool touching = false;
    for (int a = 0; a < n; ++a) {
        eta_[a] = heights_[a] - older[a];
        b_[a] = -free[a] - thread_.coupling(a) * thread;
        touching = touching || eta_[a] > 0 || eta_[a] + b_[a] > 0;
    }
    bool converged = true;
    if (lossy_) lossy_->lost = 0;
    if (touching) {
        const bool damped = lossy_ && damp();
        const GramSolution s = gram_.solve(eta_.data(), b_.data(), r_.data(), force);
        converged = s.converged;
        if (damped) {
            settle(force);
            gram_.set(lossy_->theta);
        }
        for (int a = 0; a < n; ++a) {
            thread -= thread_.answer(a, force[a]);
            tally_.force.note(force[a]);
            tally_.deepest = std::max(tally_.deepest, eta_[a] - r_[a]);
        }
        ++tally_.solves;
        tally_.iterations += s.iterations;
        tally_.most_iterations = std::max(tally_.most_iterations, s.iterations);
        tally_.residual = std::max(tally_.residual, s.residual);
    } else {
        for (int a = 0; a < n; ++a) force[a] = 0;
    }
    if (thread_.law()) force[n] = thread;
    return converged;
}

double ObstacleStep::loss(double r_c) const {
    return thread_.lost(series_ ? series_->thread_moved : r_c) + (series_ ? series_->lost / span_ : 0) +
           (lossy_ ? lossy_->lost / span_ : 0);
}

double ObstacleStep::potential(const double* reading, int level) const {
    const double* P = series_ ? series_->P[level].data() : nullptr;
    double sum = series_ ? series_->stored(P) : 0;
    const auto at = [&](int a) { return reading[a] + (series_ ? series_->yield(a, P) : 0); };
    for (int a = 0; a < contacts_; ++a) sum += laws_[a].potential(heights_[a] - at(a));
    return thread_.law() ? sum + thread_.stored(at(contacts_)) : sum;
}

void ObstacleStep::put_in_series(const MissingMatrix& missing, int levels) {
    Series z{Residual(missing, span_), {}, {}, {}};
    std::vector<double> theta = theta_;
    for (std::size_t i = 0; i < theta.size(); ++i) theta[i] += z.K[i];
    *this = ObstacleStep(std::vector(laws_), std::vector(heights_), std::optional(thread_.law()), theta, span_);
    levels_ = levels;
    for (auto* v : {&z.P[0], &z.P[1], &z.older, &z.free}) v->assign(z.points, 0.0);
    series_ = std::move(z);
}

void ObstacleStep::begin(const double*) {
    if (series_)
        for (auto& P : series_->P) std::fill(P.begin(), P.end(), 0.0);
}

void ObstacleStep::follow(const ObstacleStep& first) {
    if (!series_) return;
    std::fill(series_->P[0].begin(), series_->P[0].end(), 0.0);
    series_->P[1] = first.series_->P[0];
}

void ObstacleStep::forces(int level, double* force) const {
    if (series_) std::copy(series_->P[level].begin(), series_->P[level].end(), force);
}

bool ObstacleStep::solve_in_series(const double* older, const double* free, double* force) noexcept {
    Series& z = *series_;
    const std::size_t n = z.points;
    std::vector<double>& P = z.P[0];
    for (std::size_t a = 0; a < n; ++a) {
        z.older[a] = older[a] + z.yield(a, P.data());
        z.free[a] = free[a] - Residual::times(z.K, a, P.data(), n);
    }
    const bool converged = solve_points(z.older.data(), z.free.data(), force);
    if (thread_.law()) z.thread_moved = z.free[n - 1] + Residual::times(theta_, n - 1, force, n);
    for (std::size_t a = 0; a < n; ++a) z.free[a] = force[a] - P[a];
    z.lost = z.lost_in(z.free.data());
    for (std::size_t a = 0; a < n; ++a) P[a] += Residual::times(z.W, a, z.free.data(), n);
    if (levels_ == 2) z.P[0].swap(z.P[1]);
    return converged;
}

}  // namespace jvari
