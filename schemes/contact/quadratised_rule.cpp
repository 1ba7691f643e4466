// Source: Ducceschi, Bilbao, Willemsen & Serafin 2021; the release and its convex form:
// quadratised_rule.hpp. Newton's method with a derivative line search (Nocedal & Wright 2006,
// chapter 3).
#include "schemes/contact/quadratised_rule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jvari {

namespace {
constexpr int most_steps = 200;
constexpr double root_rounding = 2e-15, root_change = 1e-9;  // see contact_gram.cpp
constexpr double no_psi = 1e-150;                            // [sqrt(J)] its square is no number
}  // namespace

QuadratisedContacts::QuadratisedContacts(std::span<const ContactLaw> laws,
                                         std::span<const double> theta, int levels,
                                         Quadratisation variant)
    : ObstacleRule(laws, theta),
      variant_(variant),
      levels_(levels),
      c_(levels == 1 ? 0.5 : 1),
      system_(laws.size()) {
    const std::size_t n = laws.size();
    for (const ContactLaw& law : laws) psi_of_.push_back(QuadratisedLaw::make(law, variant, c_));
    for (auto* v : {&psi_, &next_, &eta_, &free_, &f_, &gamma_, &scale_, &df_, &work_})
        v->assign(n, 0.0);
    for (auto* v : {&kappa_, &shift_}) v->assign(n, 0.0);
    set_.assign(n, 0);
}

void QuadratisedContacts::lose(std::span<const StepLoss> loss) {
    for (int a = 0; a < contacts(); ++a) kappa_[a] = loss[a].kappa;
}

void QuadratisedContacts::begin(const double* eta, const double*) {
    for (int a = 0; a < contacts(); ++a) psi_[a] = psi_of_[a].psi(eta[a]);
    seen_ = {};
    lost_ = 0;
}

bool QuadratisedContacts::acts(const BeforeStep& at) const {
    bool any = false;
    for (int a = 0; a < contacts(); ++a) any = any || at.now[a] > 0 || psi_[a] != 0;
    return any;
}

bool QuadratisedContacts::solve_linearly() noexcept {
    many_ = 0;
    for (int a = 0; a < contacts(); ++a) {
        next_[a] = psi_[a];
        const double gamma = eta_[a] > 0 ? psi_of_[a].gamma(eta_[a]) : 0;
        gamma_[a] = gamma;
        // F = G - (c gamma^2 + D) r, the loss with G at r = 0
        shift_[a] = kappa_[a] * std::max(0.0, 2 * c_ * gamma * psi_[a]);
        scale_[a] = std::sqrt(c_ * gamma * gamma + shift_[a]);
        if (gamma != 0) set_[many_++] = a;
    }
    if (!factor()) return false;
    for (int i = 0; i < many_; ++i) {
        const int a = set_[i];
        work_[i] = 2 * c_ * gamma_[a] * psi_[a] / scale_[a] - scale_[a] * free_[a];
    }
    system_.solve(work_.data());
    for (int i = 0; i < many_; ++i) {
        const int a = set_[i];
        f_[a] = scale_[a] * work_[i];
        const double square = scale_[a] * scale_[a],
                     way = (2 * c_ * gamma_[a] * psi_[a] - f_[a]) / square;
        next_[a] = psi_[a] - gamma_[a] * way;
        lost_ += shift_[a] * way * way / levels_;
    }
    return true;
}

double QuadratisedContacts::falls_short(int a) const noexcept {
    double sum = free_[a];
    for (int b = 0; b < contacts(); ++b) sum += theta_[a * contacts() + b] * f_[b];
    return sum - way(a);
}

// psi+ >= 0
bool QuadratisedContacts::stays(int a) const noexcept {
    return gamma_[a] > 0 && f_[a] >= c_ * psi_[a] * (gamma_[a] - kappa_[a] * psi_[a]);
}

// The r to which f belongs: f = c gamma (2 psi - gamma r)(1 - kappa r), or for psi+ = 0 f = c psi^2
// (1/r - kappa)
double QuadratisedContacts::way(int a) const noexcept {
    if (!stays(a)) return c_ * psi_[a] * psi_[a] / (f_[a] + shift_[a]);
    const double left = 2 * psi_[a] - f_[a] / (c_ * gamma_[a]);
    if (kappa_[a] == 0) return left / gamma_[a];
    return 2 * left / (gamma_[a] + 2 * kappa_[a] * psi_[a] + slant(a));
}

// -df/dr/(c gamma) for psi+ >= 0
double QuadratisedContacts::slant(int a) const noexcept {
    const double unequal = gamma_[a] - 2 * kappa_[a] * psi_[a];
    return std::sqrt(unequal * unequal + 4 * kappa_[a] * f_[a] / c_);
}

// A first guess: each contact with the others' forces held. Newton's steps only double a force that
// is far too small.
void QuadratisedContacts::guess() noexcept {
    const int n = contacts();
    for (int a = 0; a < n; ++a) {
        if (psi_[a] < no_psi) psi_[a] = 0;
        shift_[a] = c_ * kappa_[a] * psi_[a] * psi_[a];  // f > -shift
        gamma_[a] = eta_[a] > 0 ? psi_of_[a].gamma(eta_[a]) : 0;
        next_[a] = f_[a] = 0;
    }
    for (int sweep = 0; sweep < 3; ++sweep)
        for (int a = 0; a < n; ++a) {
            if (!(gamma_[a] > 0 || psi_[a] > 0)) continue;
            double rest = free_[a];
            for (int b = 0; b < n; ++b)
                if (b != a) rest += theta_[a * n + b] * f_[b];
            const double theta = theta_[a * n + a];
            f_[a] = std::max(solve_quadratised(psi_of_[a], eta_[a], psi_[a], rest, theta).force,
                             psi_[a] > 0 ? std::numeric_limits<double>::min() : 0);
        }
}

// Newton's df for the contacts in set_. A contact at f = 0 that would go below leaves the set, and
// the other members aim again: otherwise they would swap from step to step.
bool QuadratisedContacts::aim(bool& all) noexcept {
    for (all = true; many_ > 0;) {
        for (int i = 0; i < many_; ++i) {
            const int a = set_[i];
            // (-dr/dF)^-1/2
            scale_[a] = !stays(a)        ? (f_[a] + shift_[a]) / (std::sqrt(c_) * psi_[a])
                        : kappa_[a] == 0 ? std::sqrt(c_) * gamma_[a]
                                         : std::sqrt(c_ * gamma_[a] * slant(a));
            work_[i] = -scale_[a] * falls_short(a);
        }
        if (!factor()) return false;
        system_.solve(work_.data());
        int left = 0;
        for (int i = 0; i < many_; ++i) {
            const int a = set_[i];
            df_[a] = scale_[a] * work_[i];
            if (psi_[a] == 0 && f_[a] == 0 && df_[a] < 0) df_[a] = 0;
            else set_[left++] = a;
        }
        if (left == many_) return true;
        many_ = left;
        all = false;
    }
    return true;
}

// Part of df, up to `most`, at which the merit's slope has fallen by half, past its minimum
double QuadratisedContacts::search(double most) noexcept {
    const auto slope = [this](double t) {
        double sum = 0;
        for (int a = 0; a < contacts(); ++a) f_[a] += t * df_[a];
        for (int i = 0; i < many_; ++i) sum += df_[set_[i]] * falls_short(set_[i]);
        for (int a = 0; a < contacts(); ++a) f_[a] -= t * df_[a];
        return sum;
    };
    const double start = slope(0);
    if (!(slope(most) > 0.25 * std::abs(start))) return most;
    double low = 0, high = most, t = most;
    for (int i = 0; i < 60; ++i) {
        t = 0.5 * (low + high);
        const double at = slope(t);
        (at > 0 ? high : low) = t;
        if (at <= 0 && at >= 0.5 * start) break;
    }
    return low > 0 ? low : t;
}

bool QuadratisedContacts::release() noexcept {
    const int n = contacts();
    guess();
    bool solved = false;
    int step = 0;
    for (; step < most_steps && !solved; ++step) {
        many_ = 0;
        for (int a = 0; a < n; ++a) {
            df_[a] = 0;
            if (psi_[a] > 0 || (gamma_[a] > 0 && (f_[a] > 0 || falls_short(a) < 0)))
                set_[many_++] = a;
        }
        if (many_ == 0) return true;
        if (!aim(solved)) return false;
        double t = 1;
        for (int i = 0; i < many_; ++i) {
            const int a = set_[i];
            double reach = std::abs(free_[a]) + std::abs(eta_[a]);
            for (int b = 0; b < n; ++b) reach += std::abs(theta_[a * n + b] * f_[b]);
            solved = solved && (std::abs(df_[a]) <= root_change * (std::abs(f_[a]) + shift_[a]) ||
                                std::abs(falls_short(a)) <= root_rounding * reach);
            if (f_[a] + df_[a] <= -shift_[a])
                t = std::min(t, psi_[a] > 0 ? -0.9 * (f_[a] + shift_[a]) / df_[a]
                                : f_[a] > 0 ? -f_[a] / df_[a]
                                            : 1.0);
        }
        if (!solved) t = search(t);
        for (int i = 0; i < many_; ++i) {
            const int a = set_[i];
            const double most = -0.95 * (f_[a] + shift_[a]), change = std::max(t * df_[a], most);
            // all but the rounding of t
            const bool gone = psi_[a] == 0 && f_[a] + t * df_[a] <= 1e-12 * f_[a];
            f_[a] = gone ? 0 : f_[a] + (psi_[a] > 0 ? change : t * df_[a]);
        }
    }
    iterations_ = step;
    for (int a = 0; a < n; ++a) {
        if (stays(a))
            next_[a] = kappa_[a] == 0 ? f_[a] / (c_ * gamma_[a]) - psi_[a]
                                      : std::max(0.0, psi_[a] - gamma_[a] * way(a));
        // kappa F r^2/(1 - kappa r), in the form c (psi^2 - psi+^2) kappa r
        if (kappa_[a] != 0 && (gamma_[a] > 0 || psi_[a] > 0))
            lost_ +=
                c_ * (psi_[a] - next_[a]) * (psi_[a] + next_[a]) * kappa_[a] * way(a) / levels_;
    }
    return solved;
}

GramSolution QuadratisedContacts::solve(const BeforeStep& at, double* r, double* force) noexcept {
    for (int a = 0; a < contacts(); ++a) {
        eta_[a] = at.now[a];
        free_[a] = -at.b[a];
        f_[a] = 0;
        next_[a] = psi_[a];
    }
    iterations_ = 0;
    lost_ = 0;
    bool solved = true;
    if (contacts() == 1 && kappa_[0] == 0) {  // in closed form
        const QuadratisedStep s =
            solve_quadratised(psi_of_[0], eta_[0], psi_[0], free_[0], theta_[0]);
        f_[0] = s.force;
        next_[0] = s.psi;
    } else {
        solved = variant_ == Quadratisation::released ? release() : solve_linearly();
    }
    end(at, r, force);
    return {iterations_, 0, solved};
}

GramSolution QuadratisedContacts::start(const BeforeStep& at, double* r, double* force) noexcept {
    many_ = 0;
    lost_ = 0;
    for (int a = 0; a < contacts(); ++a) {
        eta_[a] = at.now[a];
        f_[a] = 0;
        next_[a] = psi_[a];
        gamma_[a] = eta_[a] > 0 ? psi_of_[a].gamma(eta_[a]) : 0;
        scale_[a] = std::sqrt(2.0) * gamma_[a];  // for F/2 by 2 Theta
        if (gamma_[a] > 0) set_[many_++] = a;
    }
    if (!factor()) return {0, 0, false};
    for (int i = 0; i < many_; ++i) work_[i] = psi_[set_[i]] + gamma_[set_[i]] * at.b[set_[i]];
    system_.solve(work_.data());
    for (int i = 0; i < many_; ++i) {
        next_[set_[i]] = std::max(work_[i], 0.0);
        f_[set_[i]] = 2 * gamma_[set_[i]] * next_[set_[i]];
    }
    end(at, r, force);
    return {};
}

void QuadratisedContacts::end(const BeforeStep& at, double* r, double* force) noexcept {
    const int n = contacts();
    for (int a = 0; a < n; ++a) {
        r[a] = -at.b[a];
        for (int b = 0; b < n; ++b) r[a] += theta_[a * n + b] * f_[b];
    }
    for (int a = 0; a < n; ++a) {
        force[a] = f_[a];
        psi_[a] = next_[a];
        const double newer = psi_of_[a].psi(at.older[a] - r[a]), now = psi_of_[a].psi(at.now[a]);
        seen_.note(psi_[a], levels_ == 1 ? newer : std::sqrt(0.5 * (newer * newer + now * now)));
    }
}

}  // namespace jvari
