// Source: body_step.hpp.
#include "schemes/body/body_step.hpp"

namespace jvari {

BodyStep::BodyStep(const std::vector<StringPoints>& strings,
                   const std::vector<std::vector<int>>& place, double beta, double kappa)
    : beta_(beta), kappa_(kappa) {
    std::size_t all = 0;
    for (const StringPoints& s : strings) all += s.count();
    for (auto* v : {&e_, &to_body_, &c_}) v->assign(all, 0.0);
    theta_.assign(all * all, 0.0);
    for (std::size_t k = 0; k < strings.size(); ++k) {
        const StringPoints& s = strings[k];
        const int n = s.count(), m = n;  // m: the body
        inertia_ += s.mass / 3;
        rest_mass_ += s.mass / 3 - s.theta[m * (n + 1) + m] / kappa;
        stiffness_ += s.tension / s.length;
        for (int p = 0; p < n; ++p) {
            const int at = place[k][p];
            e_[at] = -s.positions[p] / s.length;
            to_body_[at] = s.theta[p * (n + 1) + m];
            c_[at] = e_[at] - to_body_[at] / kappa;
            for (int q = 0; q < n; ++q) theta_[at * all + place[k][q]] = s.theta[p * (n + 1) + q];
        }
    }
    D_ = 1 + beta * (0.5 * stiffness_ + rest_mass_ / kappa);
    for (std::size_t p = 0; p < all; ++p)
        for (std::size_t q = 0; q < all; ++q) theta_[p * all + q] += beta * c_[p] * c_[q] / D_;
}

void BodyStep::approach(double inertia, double pluck, const BodyMotion& body, double* older,
                        double* now, double* free) noexcept {
    f_ = (pluck - inertia - rest_mass_ * body.a - stiffness_ * (body.w + 0.5 * body.r)) / D_;
    a_ = body.a;
    for (std::size_t p = 0; p < e_.size(); ++p) {
        older[p] += e_[p] * body.w;
        now[p] += e_[p] * body.now;
        free[p] += e_[p] * body.r - to_body_[p] * body.a + beta_ * c_[p] * f_;
    }
}

void BodyStep::pass(const double* force) noexcept {
    for (std::size_t p = 0; p < e_.size(); ++p) f_ += c_[p] * force[p] / D_;
    a_ += beta_ / kappa_ * f_;
}

}  // namespace jvari
