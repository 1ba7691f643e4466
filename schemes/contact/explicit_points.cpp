#include "schemes/contact/explicit_points.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

ExplicitPoints::ExplicitPoints(std::span<const ContactLaw> laws, std::span<const double> heights, const std::optional<Thread>& thread,
                               std::span<const double> theta, double span, std::span<const double> contact_loss)
    : laws_(laws.begin(), laws.end()),
      heights_(heights.begin(), heights.end()),
      beta_(contact_loss.begin(), contact_loss.end()),
      theta_(theta.begin(), theta.end()),
      thread_(thread),
      span_(span) {
    const std::size_t points = laws_.size() + (thread_ ? 1 : 0);
    for (auto* v : {&resist_, &root_, &x_}) v->assign(points, 0.0);
    matrix_.assign(points * points, 0.0);
    held_.reserve(points);
}

bool ExplicitPoints::next(const double* now, const double* older, const double* free, double* force) noexcept {
    const std::size_t n = laws_.size();
    for (std::size_t a = 0; a < n; ++a) resist_[a] = beta_[a] * laws_[a].force(heights_[a] - now[a]) / span_;
    if (thread_) resist_[n] = 0.5 * thread_->stiffness + thread_->damping / span_;
    return solve(now, older, 1, free, force);
}

bool ExplicitPoints::first(const double* now, const double* free, double* force) noexcept {
    const std::size_t n = laws_.size();
    std::fill(resist_.begin(), resist_.end(), 0.0);
    if (thread_) resist_[n] = 0.5 * thread_->stiffness;
    return solve(now, now, 0.5, free, force);
}

bool ExplicitPoints::solve(const double* now, const double* outer, double share, const double* free, double* force) noexcept {
    const std::size_t n = laws_.size(), points = resist_.size();
    held_.clear();
    for (std::size_t a = 0; a < n; ++a) force[a] = share * laws_[a].force(heights_[a] - now[a]);
    if (thread_) force[n] = share * thread_->stiffness * (thread_->height - outer[n]);
    for (std::size_t p = 0; p < points; ++p) {
        root_[p] = std::sqrt(resist_[p]);
        if (resist_[p] > 0) held_.push_back(static_cast<int>(p));
    }
    const std::size_t m = held_.size();
    for (std::size_t i = 0; i < m; ++i) {  // row by row: the factor L of I + S^1/2 Theta S^1/2, and L x = S^1/2 (free + Theta F_0)
        const std::size_t p = static_cast<std::size_t>(held_[i]);
        double right = free[p];
        for (std::size_t q = 0; q < points; ++q) right += theta_[p * points + q] * force[q];
        right *= root_[p];
        double* row = matrix_.data() + i * points;
        for (std::size_t j = 0; j <= i; ++j) {
            const double* other = matrix_.data() + j * points;
            const std::size_t q = static_cast<std::size_t>(held_[j]);
            double sum = root_[p] * theta_[p * points + q] * root_[q] + (i == j ? 1 : 0);
            for (std::size_t l = 0; l < j; ++l) sum -= row[l] * other[l];
            row[j] = i == j ? std::sqrt(sum) : sum / other[j];
            if (j < i) right -= row[j] * x_[j];
        }
        x_[i] = right / row[i];
    }
    for (std::size_t i = m; i-- > 0;) {
        for (std::size_t l = i + 1; l < m; ++l) x_[i] -= matrix_[l * points + i] * x_[l];
        x_[i] /= matrix_[i * points + i];
    }
    lost_ = 0;
    for (std::size_t i = 0; i < m; ++i) {
        const std::size_t p = static_cast<std::size_t>(held_[i]);
        force[p] -= root_[p] * x_[i];
        if (p < n) lost_ += x_[i] * x_[i];  // D r^2
    }
    for (std::size_t a = 0; a < n; ++a) {
        range_.note(force[a]);
        deepest_ = std::max(deepest_, heights_[a] - now[a]);
    }
    return true;
}

double ExplicitPoints::potential(const double* reading) const {
    double sum = 0;
    for (std::size_t a = 0; a < laws_.size(); ++a) sum += laws_[a].potential(heights_[a] - reading[a]);
    if (!thread_) return sum;
    const double stretch = thread_->height - reading[laws_.size()];
    return sum + 0.5 * thread_->stiffness * stretch * stretch;
}

double ExplicitPoints::loss(double r_c) const {
    return (thread_ ? thread_->damping * (r_c / span_) * (r_c / span_) : 0) + lost_ / span_;
}

void ExplicitPoints::clear() {
    range_ = {};
    deepest_ = lost_ = 0;
}

std::vector<Fact> ExplicitPoints::facts() const {
    return {{facts::contact_points, static_cast<double>(laws_.size())},
            {facts::smallest_contact_force, range_.least},
            {facts::largest_contact_force, range_.most},
            {facts::deepest_penetration, deepest_}};
}

}  // namespace jvari
