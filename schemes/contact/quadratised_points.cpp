// Source: Ducceschi, Bilbao, Willemsen & Serafin 2021; the release and its convex form: quadratised_points.hpp. Newton's method with a
// derivative line search (Nocedal & Wright 2006, chapter 3).
#include "schemes/contact/quadratised_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jvari {

namespace {
constexpr double c = 0.5;  // of a two-point form
constexpr int most_steps = 60;
constexpr double rounding = 2e-15, force_change = 1e-9;  // as in contact_gram.cpp
constexpr double no_psi = 1e-150;                        // [sqrt(J)] its square is no number
}  // namespace

QuadratisedPoints::QuadratisedPoints(std::span<const ContactLaw> laws, std::span<const double> heights, const std::optional<Thread>& thread,
                                     std::span<const double> theta, double span, Quadratisation variant)
    : heights_(heights.begin(), heights.end()),
      thread_(thread, static_cast<int>(laws.size()), theta, span),
      span_(span),
      variant_(variant),
      theta_(thread_.between_contacts(theta)) {
    const int n = static_cast<int>(laws.size());
    for (const ContactLaw& law : laws) laws_.push_back(QuadratisedLaw::make(law, variant, c));
    damped_ = matrix_ = theta_;
    for (auto* v : {&beta_, &psi_, &next_, &eta_, &free_, &f_, &r_, &drag_, &gamma_, &scale_, &df_, &work_}) v->assign(n, 0.0);
    set_.assign(n, 0);
}

void QuadratisedPoints::lose(std::span<const double> beta) {
    beta_.assign(beta.begin(), beta.end());
}

void QuadratisedPoints::begin(const double* reading) {
    for (int a = 0; a < contacts(); ++a) psi_[a] = laws_[a].psi(heights_[a] - reading[a]);
}

void QuadratisedPoints::clear() {
    seen_ = {};
    solves_ = iterations_ = most_iterations_ = 0;
    lost_ = 0;
}

bool QuadratisedPoints::factor() noexcept {
    const int n = contacts();
    for (int i = 0; i < many_; ++i) {
        double* row = matrix_.data() + i * n;
        for (int j = 0; j <= i; ++j) {
            const double* other = matrix_.data() + j * n;
            double sum = scale_[set_[i]] * damped_[set_[i] * n + set_[j]] * scale_[set_[j]] + (i == j);
            for (int l = 0; l < j; ++l) sum -= row[l] * other[l];
            row[j] = i == j ? std::sqrt(sum) : sum / other[j];
        }
        if (!(row[i] > 0) || !std::isfinite(row[i])) return false;
    }
    return true;
}

void QuadratisedPoints::back(double* x) const noexcept {
    const int n = contacts();
    for (int i = 0; i < many_; ++i) {
        for (int l = 0; l < i; ++l) x[i] -= matrix_[i * n + l] * x[l];
        x[i] /= matrix_[i * n + i];
    }
    for (int i = many_ - 1; i >= 0; --i) {
        for (int l = i + 1; l < many_; ++l) x[i] -= matrix_[l * n + i] * x[l];
        x[i] /= matrix_[i * n + i];
    }
}

// Theta and free of the contacts with D: column by column (I + Theta D)^-1, by S = D^1/2 on the closed ones, Theta - Theta S M^-1 S Theta.
bool QuadratisedPoints::damp() noexcept {
    const int n = contacts();
    many_ = 0;
    for (int a = 0; a < n; ++a) {
        drag_[a] = beta_[a] > 0 && eta_[a] > 0 ? beta_[a] * laws_[a].law.force(eta_[a]) / span_ : 0;
        scale_[a] = std::sqrt(drag_[a]);
        if (drag_[a] > 0) set_[many_++] = a;
    }
    damped_ = theta_;
    if (many_ == 0) return true;
    if (!factor()) return false;
    const auto through = [&](double* column, int stride) {  // x <- x - Theta S M^-1 S x
        for (int i = 0; i < many_; ++i) work_[i] = scale_[set_[i]] * column[set_[i] * stride];
        back(work_.data());
        for (int a = 0; a < n; ++a)
            for (int i = 0; i < many_; ++i) column[a * stride] -= theta_[a * n + set_[i]] * scale_[set_[i]] * work_[i];
    };
    through(free_.data(), 1);
    for (int b = 0; b < n; ++b) through(damped_.data() + b, n);
    for (int a = 0; a < n; ++a)  // symmetric to the last bit
        for (int b = 0; b < a; ++b) damped_[a * n + b] = damped_[b * n + a];
    return true;
}

bool QuadratisedPoints::solve_linearly() noexcept {
    many_ = 0;
    for (int a = 0; a < contacts(); ++a) {
        next_[a] = psi_[a];
        double gamma = 0;
        if (eta_[a] > 0) gamma = laws_[a].gamma(eta_[a]) * (variant_ == Quadratisation::constrained && psi_[a] < 0 ? -1 : 1);
        else if (variant_ == Quadratisation::constrained && free_[a] != 0) gamma = psi_[a] / free_[a];
        gamma_[a] = gamma;
        scale_[a] = std::sqrt(c) * gamma;
        if (gamma != 0) set_[many_++] = a;
    }
    if (!factor()) return false;
    for (int i = 0; i < many_; ++i) work_[i] = std::sqrt(c) * (2 * psi_[set_[i]] - gamma_[set_[i]] * free_[set_[i]]);
    back(work_.data());
    for (int i = 0; i < many_; ++i) {
        f_[set_[i]] = scale_[set_[i]] * work_[i];
        next_[set_[i]] = work_[i] / std::sqrt(c) - psi_[set_[i]];
    }
    return true;
}

double QuadratisedPoints::falls_short(int a) const noexcept {
    double sum = free_[a];
    for (int b = 0; b < contacts(); ++b) sum += damped_[a * contacts() + b] * f_[b];
    const bool stays = gamma_[a] > 0 && f_[a] >= c * gamma_[a] * psi_[a];
    return sum - (stays ? (2 * psi_[a] - f_[a] / (c * gamma_[a])) / gamma_[a] : c * psi_[a] * psi_[a] / f_[a]);
}

bool QuadratisedPoints::release() noexcept {
    const int n = contacts();
    for (int a = 0; a < n; ++a) {  // a first guess: each contact alone
        if (psi_[a] < no_psi) psi_[a] = 0;
        gamma_[a] = eta_[a] > 0 ? laws_[a].gamma(eta_[a]) : 0;
        next_[a] = 0;
        f_[a] = gamma_[a] > 0 || psi_[a] > 0
                    ? std::max(solve_quadratised(laws_[a], eta_[a], psi_[a], free_[a], damped_[a * n + a]).force, 0.0)
                    : 0;
        if (psi_[a] > 0) f_[a] = std::max(f_[a], std::numeric_limits<double>::min());
    }
    const auto stays = [this](int a) { return gamma_[a] > 0 && f_[a] >= c * gamma_[a] * psi_[a]; };
    const auto merit_slope = [this, n](double t) {  // along f + t df
        double sum = 0;
        for (int a = 0; a < n; ++a) f_[a] += t * df_[a];
        for (int i = 0; i < many_; ++i) sum += df_[set_[i]] * falls_short(set_[i]);
        for (int a = 0; a < n; ++a) f_[a] -= t * df_[a];
        return sum;
    };
    bool solved = false;
    int step = 0;
    for (; step < most_steps && !solved; ++step) {
        many_ = 0;
        for (int a = 0; a < n; ++a) {
            df_[a] = 0;
            if (psi_[a] > 0 || (gamma_[a] > 0 && (f_[a] > 0 || falls_short(a) < 0))) set_[many_++] = a;
        }
        if (many_ == 0) return true;
        solved = true;
        for (int i = 0; i < many_; ++i) {
            const int a = set_[i];
            scale_[a] = stays(a) ? std::sqrt(c) * gamma_[a] : f_[a] / (std::sqrt(c) * psi_[a]);  // (-dr/dF)^-1/2
            work_[i] = -scale_[a] * falls_short(a);
        }
        if (!factor()) return false;
        back(work_.data());
        double t = 1;
        for (int i = 0; i < many_; ++i) {
            const int a = set_[i];
            df_[a] = scale_[a] * work_[i];
            double reach = std::abs(free_[a]) + std::abs(eta_[a]);
            for (int b = 0; b < n; ++b) reach += std::abs(damped_[a * n + b] * f_[b]);
            solved = solved && (std::abs(df_[a]) <= force_change * f_[a] || std::abs(falls_short(a)) <= rounding * reach);
            if (f_[a] + df_[a] <= 0) t = std::min(t, psi_[a] > 0 ? -0.9 * f_[a] / df_[a] : f_[a] > 0 ? -f_[a] / df_[a] : 1.0);
        }
        if (!solved) {
            const double start = merit_slope(0);
            if (merit_slope(t) > 0.25 * std::abs(start)) {  // past the minimum: bisect for a point where the slope has fallen by half
                double low = 0, high = t;
                for (int i = 0; i < 60; ++i) {
                    t = 0.5 * (low + high);
                    const double slope = merit_slope(t);
                    (slope > 0 ? high : low) = t;
                    if (slope <= 0 && slope >= 0.5 * start) break;
                }
                if (low > 0) t = low;
            }
        }
        for (int i = 0; i < many_; ++i) {
            const int a = set_[i];
            f_[a] = std::max(f_[a] + t * df_[a], psi_[a] > 0 ? 0.05 * f_[a] : 0.0);
        }
    }
    iterations_ += step;
    most_iterations_ = std::max(most_iterations_, step);
    for (int a = 0; a < n; ++a)
        if (stays(a)) next_[a] = f_[a] / (c * gamma_[a]) - psi_[a];
    return solved;
}

bool QuadratisedPoints::solve(const double* older, const double* free, double* force) noexcept {
    const int n = contacts();
    double thread = thread_.alone(older, free);
    bool acts = false, solved = true;
    for (int a = 0; a < n; ++a) {
        eta_[a] = heights_[a] - older[a];
        free_[a] = free[a] + thread_.coupling(a) * thread;
        f_[a] = drag_[a] = 0;
        next_[a] = psi_[a];
        acts = acts || eta_[a] > 0 || psi_[a] != 0;
    }
    lost_ = 0;
    if (acts) {
        ++solves_;
        solved = damp() && (variant_ == Quadratisation::released ? release() : solve_linearly());
    }
    for (int a = 0; a < n; ++a) {
        r_[a] = free_[a];
        for (int b = 0; acts && b < n; ++b) r_[a] += damped_[a * n + b] * f_[b];
    }
    for (int a = 0; a < n; ++a) {
        force[a] = f_[a] - drag_[a] * r_[a];
        lost_ += drag_[a] * r_[a] * r_[a];
        psi_[a] = next_[a];
        thread -= thread_.answer(a, force[a]);
        seen_.note(force[a], psi_[a], eta_[a] - r_[a], laws_[a].psi(eta_[a] - r_[a]));
    }
    if (thread_.law()) force[n] = thread;
    return solved;
}

double QuadratisedPoints::potential(const double* reading) const {
    double sum = 0;
    for (const double psi : psi_) sum += 0.5 * psi * psi;
    return thread_.law() ? sum + thread_.stored(reading[contacts()]) : sum;
}

double QuadratisedPoints::loss(double r_c) const {
    return lost_ / span_ + thread_.lost(r_c);
}

std::vector<Fact> QuadratisedPoints::facts() const {
    std::vector<Fact> f = seen_.list();
    f.push_back({facts::contact_points, static_cast<double>(contacts())});
    f.push_back({facts::contact_iterations_mean, solves_ > 0 ? static_cast<double>(iterations_) / static_cast<double>(solves_) : 0});
    f.push_back({facts::contact_iterations_most, static_cast<double>(most_iterations_)});
    return f;
}

}  // namespace jvari
