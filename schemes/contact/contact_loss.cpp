// Source: Issanchou et al. 2016, eqs 24-28.
#include "schemes/contact/contact_loss.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

ContactLoss::ContactLoss(const Contacts& contacts, std::vector<double> theta, double span)
    : theta_(std::move(theta)), span_(span) {
    if (std::all_of(contacts.loss.begin(), contacts.loss.end(), [](double b) { return b == 0; }))
        return;
    laws_ = contacts.laws;
    beta_ = contacts.loss;
    for (const LossLaw by : contacts.loss_law) clipped_.push_back(by == LossLaw::clipped);
    lets_go_.resize(beta_.size());
    damped_ = across_ = theta_;
    system_ = ScaledSystem(beta_.size());
    for (auto* v : {&drag_, &root_, &b_, &off_, &x_, &older_, &aside_})
        v->assign(beta_.size(), 0.0);
    closed_.resize(beta_.size());
}

// Theta and b of the contacts with D, (27) for any number of them: one alone has c = Theta D, and
// divides both by 1 + c. With S = D^1/2 on the closed ones and M = I + S Theta S = L L', X = L^-1 S
// Theta, they are Theta - X' X and b - X' L^-1 S b.
bool ContactLoss::damp_closed(const BeforeStep& at, double* b) noexcept {
    lost_ = 0;
    const int n = static_cast<int>(beta_.size());
    int m = 0;
    bool any = false;
    for (int a = 0; a < n; ++a) {
        constexpr double out_of_reach = -1e3;  // [m]
        b_[a] = b[a];
        any = any || lets_go_[a];
        older_[a] = lets_go_[a] ? out_of_reach : at.older[a];
        drag_[a] = lets_go_[a] ? 0 : beta_[a] * laws_[a].force(at.now[a]) / span_;  // (24)
        root_[a] = std::sqrt(drag_[a]);
        if (drag_[a] > 0) closed_[m++] = a;
    }
    if (m == 0 && !any) return false;
    system_.factor(theta_.data(), n, closed_.data(), m, root_.data());
    for (int i = 0; i < m; ++i) x_[i] = root_[closed_[i]] * b[closed_[i]];
    system_.forward(x_.data());
    for (int c = 0; c < n; ++c) {
        double* x = across_.data() + c * n;
        for (int i = 0; i < m; ++i) x[i] = root_[closed_[i]] * theta_[closed_[i] * n + c];
        system_.forward(x);
        for (int i = 0; i < m; ++i) b[c] -= x[i] * x_[i];
        for (int a = 0; a <= c; ++a) {
            double sum = theta_[a * n + c];
            for (int i = 0; i < m; ++i) sum -= across_[a * n + i] * x[i];
            damped_[a * n + c] = damped_[c * n + a] = sum;
        }
    }
    for (int a = 0; a < n; ++a) {
        aside_[a] = lets_go_[a] ? b[a] : 0;
        if (lets_go_[a]) b[a] = 0;
    }
    return true;
}

// F - D r falls as r grows, so that a contact which pulls once it is solved for still would where
// nothing holds it; of several, those that others hold back may have to be caught again.
bool ContactLoss::clip(const BeforeStep& at, const double* r, const double* force,
                       double* b) noexcept {
    bool changed = false;
    for (std::size_t a = 0; a < clipped_.size(); ++a) {
        if (!clipped_[a]) continue;
        const double given =
                         laws_[a].potential(at.older[a]) - laws_[a].potential(at.older[a] - r[a]),
                     D = beta_[a] * laws_[a].force(at.now[a]) / span_;
        const char go =
            lets_go_[a] ? r[a] > 0 && given <= (1 + 1e-9) * D * r[a] * r[a] : force[a] < 0;
        changed = changed || go != lets_go_[a];
        lets_go_[a] = go;
    }
    if (changed) {
        std::copy(b_.begin(), b_.end(), b);
        damp_closed(at, b);
    }
    return changed;
}

// Where D Theta >> 1, a contact that creeps, the two terms of F - D r nearly cancel and r is small
// beside b: what rounding then leaves of r = -b + Theta F is put right by changes of r that D alone
// resists, D dr = S M^-1 S off.
void ContactLoss::settle(const BeforeStep& at, double* r, double* force) noexcept {
    const int n = static_cast<int>(beta_.size());
    int m = 0;
    for (int a = 0; a < n; ++a) {
        r[a] -= aside_[a];
        force[a] -= drag_[a] * r[a];
        m += drag_[a] > 0;
    }
    const auto miss = [&](int a) {
        double sum = -b_[a] - r[a];
        for (int c = 0; c < n; ++c) sum += theta_[a * n + c] * force[c];
        return sum;
    };
    for (int i = 0; i < m; ++i) off_[i] = root_[closed_[i]] * miss(closed_[i]);
    system_.solve(off_.data());
    for (int i = 0; i < m; ++i) {
        const double change = root_[closed_[i]] * off_[i];
        force[closed_[i]] -= change;
        r[closed_[i]] += change / drag_[closed_[i]];
    }
    for (int a = 0; a < n; ++a)
        lost_ += lets_go_[a]
                     ? laws_[a].potential(at.older[a]) - laws_[a].potential(at.older[a] - r[a])
                     : drag_[a] * r[a] * r[a];  // (25), (26), (28)
}

}  // namespace jvari
