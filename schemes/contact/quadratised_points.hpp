// One step of a string's contacts by energy quadratisation, and of its thread: obstacle_step.hpp's task, by the contacts of
// quadratised_contact.hpp. Each contact has a psi of its own (Ducceschi et al. 2021, of several collisions),
//
//     psi+ = psi - gamma r,   F = c gamma (psi + psi+),   r = free + Theta F,   c = 1/2
//
// so the forces are those of one symmetric system (I + G Theta G) x = sqrt(c) (2 psi - gamma free), G = sqrt(c) gamma, F = G x: one linear
// solve a step in the raw and constrained forms. Where psi+ would turn negative, and wherever psi > 0 out of contact, the released form has
// psi+ = 0 and F r = c psi^2. Then each r falls with its F,
//
//     r = (2 psi - F/(c gamma))/gamma  where F >= c gamma psi,   else  r = c psi^2/F,
//
// and the forces are the minimum of a convex function: Newton steps with a line search, F > 0 throughout. Whatever gamma is, F r is
// c (psi^2 - psi+^2) contact by contact, so the energy is balanced exactly.
// Contacts that lose energy pull by D r more, D = beta V'(eta)/span, as in obstacle_step.hpp; so they may pull.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/contact/quadratised_contact.hpp"

namespace jvari {

class QuadratisedPoints {
public:
    QuadratisedPoints() = default;
    // theta [m/N]: row-major over the points, the contacts first and then the thread where there is one. span: of a step, two levels.
    QuadratisedPoints(std::span<const ContactLaw>, std::span<const double> heights, const std::optional<Thread>&,
                      std::span<const double> theta, double span, Quadratisation);
    void lose(std::span<const double> beta);  // Hunt-Crossley beta of each contact [s/m]

    int contacts() const { return static_cast<int>(laws_.size()); }
    int points() const { return contacts() + (thread_.law() ? 1 : 0); }
    int dofs() const { return contacts(); }  // psi

    void begin(const double* reading);  // at t = 0
    // older and free [m] in, force on the string [N] out, one per point. False where it did not converge. Allocates nothing.
    bool solve(const double* older, const double* free, double* force) noexcept;
    double potential(const double* reading) const;  // at the step in hand [J], with psi
    double loss(double r_c) const;                  // of the last step [W]: of the thread, whose reading moved by r_c, and of the contacts
    void clear();
    std::vector<Fact> facts() const;

private:
    bool damp() noexcept;
    bool solve_linearly() noexcept;
    bool release() noexcept;
    bool factor() noexcept;                    // I + G Theta G over set_, G = scale_
    void back(double* x) const noexcept;       // solves with it, in place, by position in set_
    double falls_short(int a) const noexcept;  // free + Theta f, less the r that f belongs to

    std::vector<QuadratisedLaw> laws_;
    std::vector<double> heights_, beta_;
    ThreadAmongContacts thread_;
    double span_ = 1;
    Quadratisation variant_ = Quadratisation::released;
    std::vector<double> theta_, damped_;             // between contacts, the thread eliminated: without and with D
    std::vector<double> psi_, next_;                 // [sqrt(J)]
    std::vector<double> eta_, free_, f_, r_, drag_;  // of the step in hand
    std::vector<double> gamma_, scale_, df_, matrix_, work_;
    std::vector<int> set_;
    int many_ = 0;     // of set_
    double lost_ = 0;  // in the last step by the contacts [J]
    QuadratisedFacts seen_;
    long solves_ = 0, iterations_ = 0;
    int most_iterations_ = 0;
};

}  // namespace jvari
