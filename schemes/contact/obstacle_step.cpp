// Source: van Walstijn, Bridges & Mehes 2016, eqs 44-48, for any number of contacts and either number of time levels.
#include "schemes/contact/obstacle_step.hpp"

#include <algorithm>
#include <cmath>

#include "schemes/contact/matching_facts.hpp"

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
    if (contacts_ > 0) theta_bb_ = theta[0];
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

std::vector<Fact> ObstacleStep::series_facts() const {
    ImpactShare all;
    for (const ImpactShare& contact : impacts_) all.join(contact);
    if (series_) return matching_facts(*series_, all);
    return several_ ? std::vector<Fact>{{facts::impact_share, all.value()}} : std::vector<Fact>{};
}

bool ObstacleStep::solve(const double* older, const double* free, double* force) noexcept {
    if (!series_ && !several_) return solve_points(older, free, force);
    const bool solved = several_ ? solve_several(older, free, force) : solve_in_series(older, free, force);
    for (std::size_t a = 0; a < impacts_.size(); ++a) impacts_[a].take(force[a]);
    return solved;
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
    if (several_) r_c = several_->thread_moved;
    if (series_) return series_->damping * moved_ * moved_ / span_;
    return thread_.lost(r_c) + (several_ ? several_->lost / span_ : 0) + (lossy_ ? lossy_->lost / span_ : 0);
}

double ObstacleStep::potential(const double* reading, int level) const {
    if (series_) return series_->points.energy(contacts_ ? reading[0] : 0, thread_.law() ? reading[contacts_] : 0, Y_[level]);
    double sum = several_ ? several_->stored(several_->P[level]) : 0;
    const auto at = [&](int a) { return reading[a] + (several_ ? several_->yield(a, several_->P[level]) : 0); };
    for (int a = 0; a < contacts_; ++a) sum += laws_[a].potential(heights_[a] - at(a));
    return thread_.law() ? sum + thread_.stored(at(contacts_)) : sum;
}

void ObstacleStep::put_in_series(const MissingMatrix& C, int levels) {
    const int n = points();
    levels_ = levels;
    impacts_.assign(contacts_, ImpactShare(span_ / levels));
    if (contacts_ <= 1) {
        const Thread thread = thread_.law().value_or(Thread{});
        const SeriesPoints points(contacts_ ? &laws_[0] : nullptr, contacts_ ? heights_[0] : 0, thread.stiffness, thread.damping,
                                  thread.height, MissingCompliance(C));
        series_ = SeriesStep(points, theta_bb_, contacts_ ? thread_.coupling(0) : 0, thread_.theta_cc(), span_);
        return;
    }
    std::vector<double> theta = theta_;
    for (std::size_t i = 0; i < theta.size(); ++i) theta[i] += C.C[i];
    *this = ObstacleStep(std::vector(laws_), std::vector(heights_), std::optional(thread_.law()), theta, span_);
    levels_ = levels;
    impacts_.assign(contacts_, ImpactShare(span_ / levels));
    several_ = Several{};
    several_->C = C.C;
    for (auto* v : {&several_->P[0], &several_->P[1], &several_->older, &several_->free}) v->assign(n, 0.0);
}

void ObstacleStep::begin(const double* reading) {
    if (series_ && thread_.law()) Y_[0] = Y_[1] = begun_ = series_->start(reading[contacts_]);
    if (several_)
        for (auto& P : several_->P) std::fill(P.begin(), P.end(), 0.0);
}

void ObstacleStep::follow(const ObstacleStep& first) {
    Y_[0] = first.begun_;
    Y_[1] = first.Y_[0];
    if (!several_) return;
    std::fill(several_->P[0].begin(), several_->P[0].end(), 0.0);
    several_->P[1] = first.several_->P[1];
}

void ObstacleStep::forces(const double* reading, int level, double* force) const {
    const int n = contacts_;
    if (several_) {
        std::copy(several_->P[level].begin(), several_->P[level].end(), force);
    } else if (series_) {
        const SeriesPoints::Forces now = series_->points.forces(n ? reading[0] : 0, thread_.law() ? reading[n] : 0, Y_[level]);
        if (n) force[0] = now.b;
        if (thread_.law()) force[n] = now.c;
    }
}

bool ObstacleStep::solve_several(const double* older, const double* free, double* force) noexcept {
    Several& z = *several_;
    const int n = points();
    for (int a = 0; a < n; ++a) {
        const double yield = z.yield(a, z.P[0]);
        z.older[a] = older[a] + yield;
        z.free[a] = free[a] - yield;
    }
    const bool converged = solve_points(z.older.data(), z.free.data(), force);
    if (thread_.law()) {
        z.thread_moved = z.free[n - 1];
        for (int a = 0; a < n; ++a) z.thread_moved += theta_[(n - 1) * n + a] * force[a];
    }
    for (int a = 0; a < n; ++a) z.free[a] = force[a] - z.P[0][a];
    z.lost = z.stored(z.free);
    if (levels_ == 2) z.P[0].swap(z.P[1]);
    std::copy_n(force, n, z.P[1].begin());
    if (levels_ == 1) std::copy_n(force, n, z.P[0].begin());
    return converged;
}

bool ObstacleStep::solve_in_series(const double* older, const double* free, double* force) noexcept {
    const SeriesStep& s = *series_;
    const int c = contacts_;
    const double y_b = c ? older[0] : 0, u_b = c ? free[0] : 0, y_c = thread_.law() ? older[c] : 0, u_c = thread_.law() ? free[c] : 0,
                 Y = Y_[0];
    const double v = thread_.law() ? s.pull(s.points.stretch(y_c, Y), u_c, Y) : 0;
    ContactSolution x;
    if (c) {
        const double zeta = s.points.approach(y_b, y_c, Y), b = s.approach(u_b, u_c, v, Y);
        const SeriesLaw& law = s.points.law;
        x = law.law.alpha == 1 ? solve_linear_contact(law.both, zeta, b, s.theta) : solve_series_contact(law, zeta, b, s.theta);
        force[0] = x.force;
        if (x.force > 0 || zeta > 0) {
            tally_.force.note(x.force);
            tally_.deepest = std::max(tally_.deepest, law.depth(zeta - x.r));
            ++tally_.solves;
            tally_.iterations += x.iterations;
            tally_.most_iterations = std::max(tally_.most_iterations, x.iterations);
            tally_.residual = std::max(tally_.residual, x.residual);
        }
    }
    if (thread_.law()) {
        force[c] = v - s.beta * x.force;
        moved_ = s.moved(force[c], Y);
    }
    Y_[0] = levels_ == 2 ? Y_[1] : Y + moved_;
    Y_[1] = Y + moved_;
    return x.converged;
}

}  // namespace jvari
