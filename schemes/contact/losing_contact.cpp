// One contact with a loss, F = G (1 - kappa r) (StepLoss, contact.hpp), alone.
#include "schemes/contact/contact_gram.hpp"

namespace jvari {

namespace {
constexpr int most_tries = 100;
constexpr double nearly = 1e-8;  // relative; Newton's next error is about its square
}  // namespace

// With w = 1 - kappa r the spring acts through w Theta: R(w) is its r, and w - 1 + kappa R(w) rises
// with w, from below 0 at 0. Newton's method on w keeps the digits of the spring's closed form.
ContactSolution ContactGram::losing_alone(int a, double eta, double b) const noexcept {
    const double kappa = loss_[a].kappa, theta = theta_[a * count() + a];
    if (-b * kappa >= 1)
        return loss_[a].clipped ? ContactSolution{-b, 0} : pulling_alone(a, eta, b);
    double low = 0, high = 1 + kappa * b, w = std::min(1.0, high);
    ContactSolution s;
    for (int i = 1;; ++i) {
        const bool last = s.residual < nearly && i > 1;
        s = spring_alone(a, eta, b, theta * w);
        const double miss = w - 1 + kappa * s.r;
        s.iterations = i;
        s.residual = std::abs(miss) / (w + 1 + kappa * std::abs(s.r));
        s.converged = s.converged && i < most_tries;
        if (last || !s.converged) break;
        (miss > 0 ? high : low) = w;
        const double slope = spring_at(a, eta, eta - s.r).slope,
                     next = w - miss / (1 + kappa * theta * s.force / (1 - theta * w * slope));
        w = next >= low && next <= high ? next : 0.5 * (low + high);
    }
    s.force *= w;
    return s;
}

// 1/kappa <= r <= -b, from a closed contact: F <= 0
ContactSolution ContactGram::pulling_alone(int a, double eta, double b) const noexcept {
    const double theta = theta_[a * count() + a];
    double low = 1 / loss_[a].kappa, high = -b;
    ContactSolution s{high};
    for (int i = 1;; ++i) {
        const bool last = s.residual < nearly && i > 1;
        const MeanForce G = spring_at(a, eta, eta - s.r);
        const double w = loss_[a].factor(s.r);  // with the digits of r, not eta
        s.force = G.value * w;
        const double miss = s.r + b - theta * s.force;
        s.iterations = i;
        s.residual = std::abs(miss) / (s.r - b);
        s.converged = i < most_tries;
        if (last || !s.converged) return s;
        (miss > 0 ? high : low) = s.r;
        const double slope = G.slope * w - loss_[a].kappa * G.value,
                     next = s.r - miss / (1 - theta * slope);
        s.r = next >= low && next <= high ? next : 0.5 * (low + high);
    }
}

// Reads G from F if the contact closes, because its depth is below the rounding of r.
double ContactGram::lost_by(int a, double eta, double r, double force) const noexcept {
    const double w = loss_[a].factor(r), G = r > 0 ? spring_at(a, eta, eta - r).value : force / w;
    return (1 - w) * r * G;
}

}  // namespace jvari
