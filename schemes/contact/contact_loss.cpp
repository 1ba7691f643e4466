#include "schemes/contact/contact_loss.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

ContactLoss::ContactLoss(const Contacts& contacts, std::vector<double> theta, double span) : theta_(std::move(theta)), span_(span) {
    if (std::all_of(contacts.loss.begin(), contacts.loss.end(), [](double b) { return b == 0; })) return;
    laws_ = contacts.laws;
    beta_ = contacts.loss;
    damped_ = matrix_ = across_ = theta_;
    for (auto* v : {&drag_, &root_, &b_, &off_, &x_}) v->assign(beta_.size(), 0.0);
    closed_.resize(beta_.size());
}

// Theta and b of the contacts with D: with S = D^1/2 on the closed ones and M = I + S Theta S = L L', X = L^-1 S Theta,
// Theta - X' X and b - X' L^-1 S b.
bool ContactLoss::damp_closed(const BeforeStep& at, double* b) noexcept {
    lost_ = 0;
    const int n = static_cast<int>(beta_.size());
    int m = 0;
    for (int a = 0; a < n; ++a) {
        b_[a] = b[a];
        drag_[a] = beta_[a] * laws_[a].force(at.now[a]) / span_;
        root_[a] = std::sqrt(drag_[a]);
        if (drag_[a] > 0) closed_[m++] = a;
    }
    if (m == 0) return false;
    for (int i = 0; i < m; ++i) {  // row by row: L, X and x = L^-1 S b
        const int a = closed_[i];
        double* row = matrix_.data() + i * n;
        double* x = across_.data() + i * n;
        for (int j = 0; j <= i; ++j) {
            const double* other = matrix_.data() + j * n;
            double sum = root_[a] * theta_[a * n + closed_[j]] * root_[closed_[j]] + (i == j);
            for (int l = 0; l < j; ++l) sum -= row[l] * other[l];
            row[j] = i == j ? std::sqrt(sum) : sum / other[j];
        }
        double right = root_[a] * b[a];
        for (int c = 0; c < n; ++c) x[c] = root_[a] * theta_[a * n + c];
        for (int l = 0; l < i; ++l) {
            right -= row[l] * x_[l];
            for (int c = 0; c < n; ++c) x[c] -= row[l] * across_[l * n + c];
        }
        x_[i] = right / row[i];
        for (int c = 0; c < n; ++c) x[c] /= row[i];
    }
    for (int a = 0; a < n; ++a)
        for (int i = 0; i < m; ++i) b[a] -= across_[i * n + a] * x_[i];
    for (int a = 0; a < n; ++a)
        for (int c = 0; c < n; ++c) {
            double sum = theta_[a * n + c];
            for (int i = 0; i < m; ++i) sum -= across_[i * n + a] * across_[i * n + c];
            damped_[a * n + c] = sum;
        }
    return true;
}

// Where D Theta >> 1, a contact that creeps, the two terms of F - D r nearly cancel and r is small beside b: what rounding then leaves of
// r = -b + Theta F is put right by changes of r that D alone resists, D dr = S M^-1 S off.
void ContactLoss::settle(double* r, double* force) noexcept {
    const int n = static_cast<int>(beta_.size());
    int m = 0;
    for (int a = 0; a < n; ++a) {
        force[a] -= drag_[a] * r[a];
        m += drag_[a] > 0;
    }
    const auto miss = [&](int a) {
        double sum = -b_[a] - r[a];
        for (int c = 0; c < n; ++c) sum += theta_[a * n + c] * force[c];
        return sum;
    };
    for (int i = 0; i < m; ++i) {  // L^-1 S off
        double sum = root_[closed_[i]] * miss(closed_[i]);
        for (int l = 0; l < i; ++l) sum -= matrix_[i * n + l] * off_[l];
        off_[i] = sum / matrix_[i * n + i];
    }
    for (int i = m; i-- > 0;) {
        double sum = off_[i];
        for (int l = i + 1; l < m; ++l) sum -= matrix_[l * n + i] * off_[l];
        off_[i] = sum / matrix_[i * n + i];
    }
    for (int i = 0; i < m; ++i) {
        const double change = root_[closed_[i]] * off_[i];
        force[closed_[i]] -= change;
        r[closed_[i]] += change / drag_[closed_[i]];
    }
    for (int a = 0; a < n; ++a) lost_ += drag_[a] * r[a] * r[a];
}

}  // namespace jvari
