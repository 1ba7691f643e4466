// The thread is linear in the step and leaves the contact equation: van Walstijn, Bridges & Mehes 2016, eqs 44-48. With r the motion of its
// point over the step, span the time between the outer levels and k_c, r_c its stiffness and damping,
//
//     F_c = k (h_c - y_c) - phi r,   phi = k_c/2 + r_c/span,   r = free + theta_cc F_c + theta_bc F_b
//     F_c = v - beta F_b,            v = [k (h_c - y_c) - phi free]/(1 + phi theta_cc)                   (46), (47)
//
// and a contact sees theta_bb - beta theta_bc for its own compliance (48).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

struct EliminatedThread {  // beside one contact
    double k = 0, phi = 0, inverse = 1, beta = 0;
    double theta = 0;  // of the contact, the thread yielding [m/N]

    EliminatedThread() = default;
    EliminatedThread(double stiffness, double phi_c, double theta_bb, double theta_bc, double theta_cc)
        : k(stiffness), phi(phi_c), inverse(1 / (1 + phi * theta_cc)), beta(phi * theta_bc * inverse), theta(theta_bb - beta * theta_bc) {}
    double alone(double to_rest, double free) const { return (k * to_rest - phi * free) * inverse; }  // v
};

// Beside any number of them. The points' compliances are theta, row-major over the contacts and then the thread where there is one.
class ThreadAmongContacts {
public:
    ThreadAmongContacts() = default;
    ThreadAmongContacts(const std::optional<Thread>& thread, int contacts, std::span<const double> theta, double span)
        : thread_(thread), coupling_(contacts, 0.0), span_(span) {
        if (!thread) return;
        const int n = contacts, stride = n + 1;
        phi_ = 0.5 * thread->stiffness + thread->damping / span;
        theta_cc_ = theta[n * stride + n];
        inverse_ = 1 / (1 + phi_ * theta_cc_);
        for (int a = 0; a < n; ++a) coupling_[a] = theta[a * stride + n];
    }
    const std::optional<Thread>& law() const { return thread_; }
    double coupling(int a) const { return coupling_[a]; }  // theta_bc of contact a
    double phi() const { return phi_; }

    // Of the contacts alone, the thread yielding: contacts x contacts.
    std::vector<double> between_contacts(std::span<const double> theta) const {
        const int n = static_cast<int>(coupling_.size()), stride = n + (thread_ ? 1 : 0);
        std::vector<double> of_contacts;
        for (int a = 0; a < n; ++a)
            for (int c = 0; c < n; ++c) of_contacts.push_back(theta[a * stride + c] - coupling_[a] * phi_ * inverse_ * coupling_[c]);
        return of_contacts;
    }
    double alone(const double* older, const double* free) const {  // v, of the points' readings; 0 without a thread
        const std::size_t n = coupling_.size();
        return thread_ ? -(phi_ * free[n] + thread_->stiffness * (older[n] - thread_->height)) * inverse_ : 0;
    }
    double answer(int a, double force) const { return phi_ * inverse_ * coupling_[a] * force; }  // beta F of contact a
    double stored(double reading) const {
        return thread_ ? 0.5 * thread_->stiffness * (reading - thread_->height) * (reading - thread_->height) : 0;
    }
    double lost(double r) const { return thread_ ? thread_->damping * (r / span_) * (r / span_) : 0; }  // [W]

private:
    std::optional<Thread> thread_;
    std::vector<double> coupling_;
    double phi_ = 0, inverse_ = 1, theta_cc_ = 0, span_ = 1;
};

}  // namespace jvari
