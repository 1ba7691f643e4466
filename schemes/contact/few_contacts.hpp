// Solves two to five linear contacts without losses, by the discrete gradient, inline for the
// kernels that make whole steps: the equations of contact_gram.hpp, in three tiers.
//   1. One contact alone touches (tried_alone): its own equation (contact.hpp).
//   2. The contacts that touch before the step, two or more, are in full contact, the others out:
//      with D = k/2, F = (1/D + Theta)^-1 (2 eta + b) of them. The inverses of all sets, at most
//      31, are kept.
//   3. Else Newton's steps on F = S(b - Theta_off F), S_a the force of contact a by itself and
//      Theta_off the compliances between different contacts: S' = D/(1 + Theta_aa D), D = -dF/dr.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "schemes/contact/contact.hpp"
#include "schemes/contact/products.hpp"

namespace jvari {

// Contact that may touch alone: the only one that would touch without forces, else the only one
// that touches before the step, else the deepest without forces. -1 if several touch before the
// step. depth: without forces [m]
[[gnu::always_inline]] inline int tried_alone(std::uint64_t would_touch, std::uint64_t touches,
                                              const double* depth, int contacts) noexcept {
    if (std::has_single_bit(would_touch)) return std::countr_zero(would_touch);
    if (touches != 0) return std::has_single_bit(touches) ? std::countr_zero(touches) : -1;
    int one = 0;
    for (int a = 1; a < contacts; ++a)
        if (depth[a] > depth[one]) one = a;
    return one;
}

class FewContacts {
public:
    static constexpr int most = 5;
    // theta: n x n, row-major [m/N]
    FewContacts(std::span<const ContactLaw> laws, std::span<const double> theta);

    // Takes eta and b [m] and fills r [m] and the mean forces [N], n values each. Returns the
    // number of Newton iterations, or -1 if they did not end. Both forms give the same bits.
    template <int n>
    [[gnu::always_inline]] int solve(const double* eta, const double* b, double* r,
                                     double* force) const noexcept {
        double depth[n];
        const int iterations = depths<n>(eta, b, depth, force);
        for (int a = 0; a < n; ++a) r[a] = eta[a] - depth[a];
        return iterations;
    }
    int solve(const double* eta, const double* b, double* r, double* force) const noexcept;

private:
    static constexpr double rounding = 8e-15;  // in the terms of one equation
    static constexpr int most_steps = 12;

    template <int n>
    [[gnu::always_inline]] int depths(const double* eta, const double* b, double* depth,
                                      double* force) const noexcept {
        unsigned set = 0, enter = 0;
        for (int a = 0; a < n; ++a) {
            depth[a] = eta[a] + b[a];
            set |= static_cast<unsigned>(eta[a] > 0) << a;
            enter |= static_cast<unsigned>(depth[a] > 0) << a;
        }
        const unsigned touch = set | enter;
        if (touch == 0) {
            for (int a = 0; a < n; ++a) force[a] = 0;
            return 0;
        }
        const int one = tried_alone(touch, set, depth, n);
        if (one < 0) {
            if (in_full<n>(set, eta, b, depth, force)) return 0;
        } else {
            const double* to = theta_ + one * n;
            const ContactSolution s = solve_linear_contact(k_[one], eta[one], b[one], to[one]);
            bool fits = true;
            for (int a = 0; a < n; ++a) {  // no store to a place known at run time only
                const double free = eta[a] + b[a] - to[a] * s.force;
                fits = fits && (a == one || !(free > 0));
                force[a] = a == one ? s.force : 0;
                depth[a] = a == one ? eta[a] - s.r : free;
            }
            if (fits) return 0;
        }
        return newton<n>(eta, b, depth, force);
    }
    template <int n>
    [[gnu::always_inline]] bool in_full(unsigned set, const double* eta, const double* b,
                                        double* depth, double* force) const noexcept {
        double x[n], moved[n], terms[n];
        for (int a = 0; a < n; ++a) x[a] = 2 * eta[a] + b[a];
        product<n>(M_.data() + set * n * n, x, n, force);
        product<n>(theta_, force, n, moved);
        for (int a = 0; a < n; ++a) terms[a] = std::abs(b[a]) + std::abs(eta[a]);
        for (int c = 0; c < n; ++c)
            for (int a = 0; a < n; ++a) terms[a] += std::abs(theta_[c * n + a] * force[c]);
        bool fits = true;
        for (int a = 0; a < n; ++a) {
            const bool in = set >> a & 1;
            const double free = eta[a] + b[a] - moved[a];
            depth[a] = in ? give_[a] * force[a] - eta[a] : free;
            fits = fits && in == (depth[a] > 0) && std::abs(depth[a] - free) <= rounding * terms[a];
        }
        return fits;
    }
    template <int n>
    [[gnu::always_inline]] int newton(const double* eta, const double* b, double* depth,
                                      double* force) const noexcept {
        for (int a = 0; a < n; ++a) force[a] = std::max(force[a], 0.0);
        for (int i = 1; i <= most_steps; ++i) {
            double next[n], J[n][n], off[n], terms[n];
            for (int a = 0; a < n; ++a) {
                double rest = b[a];
                terms[a] = std::abs(b[a]) + std::abs(eta[a]);
                for (int c = 0; c < n; ++c) {
                    const double by = c == a ? 0 : theta_[a * n + c] * force[c];
                    rest -= by, terms[a] += std::abs(by);
                }
                const ContactSolution s =
                    solve_linear_contact(k_[a], eta[a], rest, theta_[a * n + a]);
                next[a] = s.force;
                depth[a] = eta[a] - s.r;
                const double D = s.force == 0    ? 0
                                 : eta[a] <= 0   ? (k_[a] * depth[a] - s.force) / -s.r
                                 : depth[a] <= 0 ? s.force / s.r
                                                 : 0.5 * k_[a],
                             S = D / (1 + theta_[a * n + a] * D);
                for (int c = 0; c < n; ++c) J[a][c] = c == a ? 1 : S * theta_[a * n + c];
            }
            bool solved = true;
            for (int a = 0; a < n; ++a) {
                off[a] = 0;
                for (int c = 0; c < n; ++c)
                    if (c != a) off[a] += theta_[a * n + c] * (next[c] - force[c]);
                solved = solved && std::abs(off[a]) <= rounding * terms[a];
            }
            if (solved) {
                for (int a = 0; a < n; ++a) force[a] = next[a];
                return i;
            }
            for (int a = 0; a < n; ++a) next[a] -= force[a];
            for (int k = 0; k < n; ++k)  // a scaled symmetric, positive definite matrix: no pivots
                for (int a = k + 1; a < n; ++a) {
                    const double by = J[a][k] / J[k][k];
                    for (int c = k + 1; c < n; ++c) J[a][c] -= by * J[k][c];
                    next[a] -= by * next[k];
                }
            for (int k = n - 1; k >= 0; --k) {
                for (int c = k + 1; c < n; ++c) next[k] -= J[k][c] * next[c];
                next[k] /= J[k][k];
                force[k] += next[k];
            }
        }
        return -1;
    }

    int n_;
    double k_[most] = {}, give_[most] = {};  // give_: 2/k
    double theta_[most * most] = {};
    std::vector<double> M_;  // for each set of contacts, n x n; zeros in other rows and columns
};

}  // namespace jvari
