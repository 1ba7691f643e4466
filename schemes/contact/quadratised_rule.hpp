// Contacts by energy quadratisation: each has a psi of its own, psi = sqrt(2V), stepped as a state
// (quadratised_contact.hpp; Ducceschi, Bilbao, Willemsen & Serafin 2021, of several collisions).
// With gamma taken at the level that the step is centred on,
//
//     psi+ = psi - gamma r,   F = c gamma (psi + psi+),   r = free + Theta F,
//     c = 1/2 in two-point steps, 1 in three-point ones
//
// so the forces are those of one symmetric system (I + G Theta G) x = sqrt(c) (2 psi - gamma free),
// G = sqrt(c) gamma, F = G x: one linear solve a step in the raw form. Where psi+ would turn
// negative, and wherever psi > 0 out of contact, the released form has psi+ = 0 and F r = c psi^2.
// Then each r falls with its F,
//
//     r = (2 psi - F/(c gamma))/gamma  where F >= c gamma psi,   else  r = c psi^2/F,
//
// and the forces are the minimum of a convex function: Newton steps with a line search, F > 0
// throughout. With losses F is 1 - kappa r times that, falls with r likewise, and is above -c kappa
// psi^2; the raw form has kappa r times the F of r = 0 in place of the product. Whatever gamma is,
// F r is c (psi^2 - psi+^2) contact by contact, so the energy is balanced exactly, with losses less
// kappa r of it. In three-point steps psi lives at half steps, and from rest F^0 = 2 gamma
// psi^{1/2}, psi^{1/2} = psi^0 - gamma (y^1 - y^0).
#pragma once

#include "schemes/contact/obstacle_rule.hpp"
#include "schemes/contact/quadratised_contact.hpp"

namespace jvari {

class QuadratisedContacts : public ObstacleRule {
public:
    QuadratisedContacts(std::span<const ContactLaw>, std::span<const double> theta, int levels,
                        Quadratisation);

    bool iterates() const override { return variant_ == Quadratisation::released; }
    int dofs() const override { return contacts(); }  // psi
    void lose(std::span<const StepLoss>) override;
    void begin(const double* eta, const double*) override;
    bool acts(const BeforeStep&) const override;
    GramSolution solve(const BeforeStep&, double* r, double* force) noexcept override;
    GramSolution start(const BeforeStep&, double* r, double* force) noexcept override;
    // of the half step after, in three-point steps
    double potential(int a, double) const override { return 0.5 * psi_[a] * psi_[a]; }
    double lost() const override { return lost_; }
    std::vector<Fact> facts() const override { return seen_.list(); }

private:
    bool solve_linearly() noexcept;
    void guess() noexcept;
    bool aim(bool& all) noexcept;
    double search(double most) noexcept;
    bool release() noexcept;
    bool factor() noexcept {
        return system_.factor(theta_.data(), contacts(), set_.data(), many_, scale_.data());
    }
    bool stays(int a) const noexcept;
    double way(int a) const noexcept;
    double slant(int a) const noexcept;
    double falls_short(int a) const noexcept;  // free + Theta f, less the r that f belongs to
    void end(const BeforeStep&, double* r, double* force) noexcept;
    int contacts() const { return static_cast<int>(laws_.size()); }

    std::vector<QuadratisedLaw> psi_of_;
    Quadratisation variant_;
    int levels_;
    double c_;
    std::vector<double> psi_, next_;      // [sqrt(J)]
    std::vector<double> eta_, free_, f_;  // of the step in hand
    std::vector<double> gamma_, scale_, df_, work_;
    std::vector<double> kappa_, shift_;  // of the losses [1/m]; by how much f may pull [N]
    double lost_ = 0;                    // in the last step [J]
    ScaledSystem system_;                // I + G Theta G over set_, G = scale_
    std::vector<int> set_;
    int many_ = 0, iterations_ = 0;  // of set_; of the step in hand
    QuadratisedFacts seen_;
};

// in_the_middle: gamma of two-point steps at their middle, by which the rule is of second order, in
// place of the older level.
template <Quadratisation variant, bool in_the_middle = false>
struct QuadratisedRule : QuadratisedContacts {
    static constexpr bool conserves = true;
    // gamma follows eta late, or as it is without the contacts' forces
    static constexpr bool rests_in_powers = false;
    QuadratisedRule(std::span<const ContactLaw> laws, std::span<const double> theta, int levels)
        : QuadratisedContacts(laws, theta, levels, variant) {}
    bool centred() const override { return in_the_middle; }
};

}  // namespace jvari
