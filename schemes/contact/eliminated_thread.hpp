// Eliminates threads, which are linear in the step, from the contact equation: van Walstijn,
// Bridges & Mehes 2016, eqs 44-48. With r the motion of a thread's point over the step, span the
// time between the outer levels and k_c, r_c its stiffness and damping,
//
//     F_c = k (h_c - y_c) - phi r,   phi = k_c/2 + r_c/span                                  (45)
//     r = free + theta_cc F_c + theta_bc F_b                                                 (44)
//     F_c = v - beta F_b,   v = (1 + phi theta_cc)^-1 [k (h_c - y_c) - phi free]   (46), (47)
//
// and a contact sees theta_bb - theta_bc beta for its own compliance (48). A string has one thread
// at most; on a body that moves all strings' threads are eliminated together, and phi, beta and (1
// + phi theta_cc)^-1 are matrices.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/contact/contact_gram.hpp"

namespace jvari {

class EliminatedThreads {
public:
    struct One {  // one thread, beside one contact at most
        double k = 0, rest = 0, phi = 0, inverse = 1, coupling = 0, answer = 0;
        // v
        double alone(double older, double free) const {
            return -(phi * free + k * (older - rest)) * inverse;
        }
    };

    EliminatedThreads() = default;
    // theta [m/N]: row-major over the points, the contacts first and then the threads.
    EliminatedThreads(std::vector<Thread> threads, int contacts, std::span<const double> theta,
                      double span);

    int count() const { return static_cast<int>(laws_.size()); }
    const std::vector<Thread>& laws() const { return laws_; }
    const One& one() const { return one_; }
    // theta_bc for contact a [m/N]
    double coupling(int a, int t) const { return coupling_[a * count() + t]; }
    double answer(int t, int a) const { return answer_[t * contacts_ + a]; }  // beta (47)
    // theta in (48), with yielding threads: contacts x contacts
    std::vector<double> between_contacts(std::span<const double> theta) const;
    // v for each thread, from the points' readings
    void alone(const double* older, const double* free, double* v) const noexcept {
        const int m = count();
        for (int t = 0; t < m; ++t) {
            v[t] = 0;
            for (int u = 0; u < m; ++u) {
                const int p = contacts_ + u;
                v[t] -= inverse_[t * m + u] *
                        (phi_[u] * free[p] + laws_[u].stiffness * (older[p] - laws_[u].height));
            }
        }
    }
    // r for a thread that started from a reading and pulled by F [m]   (45)
    double moved(int t, double older, double F) const {
        return phi_[t] > 0 ? (laws_[t].stiffness * (laws_[t].height - older) - F) / phi_[t] : 0;
    }
    double stored(int t, double reading) const {  // (49)
        const double stretch = reading - laws_[t].height;
        return 0.5 * laws_[t].stiffness * stretch * stretch;
    }
    // [W]   (52)
    double lost(int t, double r) const { return laws_[t].damping * (r / span_) * (r / span_); }

private:
    std::vector<Thread> laws_;
    std::vector<double> phi_, inverse_, coupling_, answer_;
    One one_;
    int contacts_ = 0;
    double span_ = 1;
};

// Statistics of the contacts in a run.
struct ContactTally {
    ForceRange force;
    double deepest = 0, residual = 0;  // [m]; relative residual of an equation
    long solves = 0, iterations = 0;
    int most_iterations = 0;

    void note(double force_, double deepest_) noexcept {  // for a contact
        force.note(force_);
        deepest = std::max(deepest, deepest_);
    }
    void note(int iterations_, double residual_) noexcept {  // for a solve
        ++solves;
        if (iterations_ == 0) return;  // closed form
        iterations += iterations_;
        most_iterations = std::max(most_iterations, iterations_);
        residual = std::max(residual, residual_);
    }
};

// One contact by the discrete gradient, which loses nothing, and one thread; either may be absent.
struct ContactAndThread {
    bool contact = false, thread = false;
    ContactLaw law;
    double height = 0, theta = 0;  // contact height; theta: with a yielding thread (48)
    EliminatedThreads::One of_thread;
    ContactTally tally;

    // Solves contact b and thread c: readings at the older level and at the step's central level,
    // increments without forces [m]; F_b, F_c [N] out. False: not converged.
    template <bool contact, bool thread>
    [[gnu::always_inline]] bool solve(double y_b, double now_b, double u_b, double y_c, double u_c,
                                      double& F_b, double& F_c) noexcept {
        const double v = thread ? of_thread.alone(y_c, u_c) : 0;  // (47)
        bool converged = true;
        F_b = 0;
        if constexpr (contact) {
            const double eta = height - y_b, b = thread ? -u_b - of_thread.coupling * v : -u_b;
            if (eta > 0 || eta + b > 0) {
                const ContactSolution s = solve_contact(law, eta, b, theta);  // (48)
                F_b = s.force;
                tally.note(F_b, std::max(height - now_b, eta - s.r));
                tally.note(s.iterations, s.residual);
                converged = s.converged;
            }
        }
        F_c = thread ? v - of_thread.answer * F_b : 0;  // (46)
        return converged;
    }
};

}  // namespace jvari
