// Source: body_step.hpp.
#include "schemes/body/body_step.hpp"

#include <Eigen/LU>

namespace jvari {

BodyStep::BodyStep(const std::vector<StringPoints>& strings, double beta, double kappa, double span)
    : strings_(strings), beta_(beta), kappa_(kappa), span_(span) {
    Contacts contacts_of_all;
    for (const StringPoints& s : strings) {
        const int n = s.count(), m = n;  // m: the body
        inertia_ += s.mass / 3;
        rest_mass_ += s.mass / 3 - s.theta[m * (n + 1) + m] / kappa;
        stiffness_ += s.tension / s.length;
        for (int p = 0; p < n; ++p) {
            e_.push_back(-s.positions[p] / s.length);
            to_body_.push_back(s.theta[p * (n + 1) + m]);
            c_.push_back(e_.back() - to_body_.back() / kappa);
        }
        const int first = points() - n;
        for (std::size_t a = 0; a < s.contacts.laws.size(); ++a) contact_.push_back(first + static_cast<int>(a));
        contacts_of_all.add(s.contacts);
        if (const auto& t = s.thread)
            thread_.push_back({first + n - 1, t->stiffness, t->damping, t->height, 0.5 * t->stiffness + t->damping / span});
    }
    D_ = 1 + beta * (0.5 * stiffness_ + rest_mass_ / kappa);

    const int all = points(), contacts = static_cast<int>(contact_.size()), threads = static_cast<int>(thread_.size());
    theta_.assign(static_cast<std::size_t>(all) * all, 0.0);
    for (int first = 0; const StringPoints& s : strings) {
        for (int p = 0; p < s.count(); ++p)
            for (int q = 0; q < s.count(); ++q) theta_[(first + p) * all + first + q] = s.theta[p * (s.count() + 1) + q];
        first += s.count();
    }
    for (int p = 0; p < all; ++p)
        for (int q = 0; q < all; ++q) theta_[p * all + q] += beta * c_[p] * c_[q] / D_;

    Eigen::MatrixXd give = Eigen::MatrixXd::Identity(threads, threads), across(threads, contacts);
    for (int t = 0; t < threads; ++t) {
        for (int v = 0; v < threads; ++v) give(t, v) += thread_[t].s * theta_[thread_[t].point * all + thread_[v].point];
        for (int b = 0; b < contacts; ++b) across(t, b) = thread_[t].s * theta_[thread_[t].point * all + contact_[b]];
    }
    const Eigen::MatrixXd yield = threads > 0 ? Eigen::MatrixXd(give.inverse()) : give, follow = yield * across;
    for (int t = 0; t < threads; ++t) {
        for (int v = 0; v < threads; ++v) yield_.push_back(yield(t, v));
        for (int b = 0; b < contacts; ++b) follow_.push_back(follow(t, b));
    }
    std::vector<double> between(static_cast<std::size_t>(contacts) * contacts);
    for (int a = 0; a < contacts; ++a)
        for (int b = 0; b <= a; ++b) {  // symmetric to the last bit
            double sum = theta_[contact_[a] * all + contact_[b]];
            for (int t = 0; t < threads; ++t) sum -= theta_[contact_[a] * all + thread_[t].point] * follow(t, b);
            between[a * contacts + b] = between[b * contacts + a] = sum;
        }
    contacts_ = {contacts_of_all, {}, between, span, 1};
    for (auto* v : {&older_, &free_}) v->assign(all, 0.0);
    for (auto* v : {&at_, &now_, &b_, &push_}) v->assign(contacts, 0.0);
    for (auto* v : {&pull_, &moved_}) v->assign(threads, 0.0);
}

BodyStep BodyStep::halved() const {
    std::vector<StringPoints> strings = strings_;
    for (StringPoints& s : strings) {
        for (double& theta : s.theta) theta *= 0.5;
    }
    return {strings, 0.5 * beta_, 0.5 * kappa_, 0.5 * span_};
}

bool BodyStep::solve(const double* older, const double* now, const double* free, double inertia, double pluck, const BodyMotion& body,
                     double* force) noexcept {
    const int all = points(), contacts = static_cast<int>(contact_.size()), threads = static_cast<int>(thread_.size());
    f_ = (pluck - inertia - rest_mass_ * body.a - stiffness_ * (body.w + 0.5 * body.r)) / D_;
    for (int p = 0; p < all; ++p) {
        older_[p] = older[p] + e_[p] * body.w;
        free_[p] = free[p] - to_body_[p] * body.a + e_[p] * body.r + beta_ * c_[p] * f_;
    }
    for (int t = 0; t < threads; ++t) {  // with no contact force
        pull_[t] = 0;
        for (int v = 0; v < threads; ++v) {
            const Spring& c = thread_[v];
            pull_[t] -= yield_[t * threads + v] * (c.s * free_[c.point] + c.stiffness * (older_[c.point] - c.rest));
        }
    }
    for (int b = 0; b < contacts; ++b) {
        at_[b] = older_[contact_[b]];
        now_[b] = now[contact_[b]] + e_[contact_[b]] * body.w;
        b_[b] = free_[contact_[b]];
        for (int t = 0; t < threads; ++t) b_[b] += theta_[contact_[b] * all + thread_[t].point] * pull_[t];
    }
    const bool converged = contacts == 0 || contacts_.solve({at_.data(), now_.data(), b_.data()}, push_.data());
    for (int b = 0; b < contacts; ++b) force[contact_[b]] = push_[b];
    for (int t = 0; t < threads; ++t) {
        double pull = pull_[t];
        for (int b = 0; b < contacts; ++b) pull -= follow_[t * contacts + b] * push_[b];
        force[thread_[t].point] = pull;
    }
    for (int t = 0; t < threads; ++t) {
        moved_[t] = free_[thread_[t].point];
        for (int p = 0; p < all; ++p) moved_[t] += theta_[thread_[t].point * all + p] * force[p];
    }
    for (int p = 0; p < all; ++p) f_ += c_[p] * force[p] / D_;
    a_ = body.a + beta_ / kappa_ * f_;
    return converged;
}

double BodyStep::potential(const double* reading, double w) noexcept {
    double sum = 0.5 * stiffness_ * w * w;
    for (std::size_t b = 0; b < contact_.size(); ++b) at_[b] = reading[contact_[b]] + e_[contact_[b]] * w;
    sum += contacts_.potential(at_.data());
    for (const Spring& c : thread_) {
        const double stretch = reading[c.point] + e_[c.point] * w - c.rest;
        sum += 0.5 * c.stiffness * stretch * stretch;
    }
    return sum;
}

double BodyStep::lost() const {
    double power = contacts_.loss(0);
    for (std::size_t t = 0; t < thread_.size(); ++t) power += thread_[t].damping * (moved_[t] / span_) * (moved_[t] / span_);
    return power;
}

}  // namespace jvari
