// Contacts by energy quadratisation: each contact has a separate psi = sqrt(2V), stepped like a
// state (quadratised_contact.hpp; Ducceschi, Bilbao, Willemsen & Serafin 2021, for several
// collisions). With gamma taken at the step's central level,
//
//     psi+ = psi - gamma r,   F = c gamma (psi + psi+),   r = free + Theta F,
//     c = 1/2 in two-point steps, 1 in three-point ones
//
// so the forces solve one symmetric system (I + G Theta G) x = sqrt(c) (2 psi - gamma free), G =
// sqrt(c) gamma, F = G x: one linear solve a step in the raw form. If psi+ would turn negative, and
// whenever psi > 0 out of contact, the released form has psi+ = 0 and F r = c psi^2. Then each r
// falls with its F,
//
//     r = (2 psi - F/(c gamma))/gamma  where F >= c gamma psi,   else  r = c psi^2/F,
//
// and the forces are the minimum of a convex function: Newton steps with a line search, F > 0
// throughout. With losses F is 1 - kappa r times that, falls with r likewise, and is above -c kappa
// psi^2; the raw form replaces the product by kappa r times the F at r = 0. Whatever gamma is, F r
// is c (psi^2 - psi+^2) contact by contact. The energy is therefore balanced exactly; with losses
// the fraction kappa r of it is lost. In three-point steps psi lives at half steps, and from rest
// F^0 = 2 gamma psi^{1/2}, psi^{1/2} = psi^0 - gamma (y^1 - y^0).
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
    // at the half step after, in three-point steps
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
    double falls_short(int a) const noexcept;  // free + Theta f, minus the r to which f belongs
    void end(const BeforeStep&, double* r, double* force) noexcept;
    int contacts() const { return static_cast<int>(laws_.size()); }

    std::vector<QuadratisedLaw> psi_of_;
    Quadratisation variant_;
    int levels_;
    double c_;
    std::vector<double> psi_, next_;      // [sqrt(J)]
    std::vector<double> eta_, free_, f_;  // in the current step
    std::vector<double> gamma_, scale_, df_, work_;
    std::vector<double> kappa_, shift_;  // by the losses [1/m]; limit on the pull in f [N]
    double lost_ = 0;                    // in the last step [J]
    ScaledSystem system_;                // I + G Theta G over set_, G = scale_
    std::vector<int> set_;
    int many_ = 0, iterations_ = 0;  // size of set_; in the current step
    QuadratisedFacts seen_;
};

// in_the_middle: gamma in two-point steps at their middle, which makes the rule second order, in
// place of the older level.
template <Quadratisation variant, bool in_the_middle = false>
struct QuadratisedRule : QuadratisedContacts {
    static constexpr bool conserves = true;
    // gamma follows eta late, or ignores the contacts' forces
    static constexpr bool rests_in_powers = false;
    QuadratisedRule(std::span<const ContactLaw> laws, std::span<const double> theta, int levels)
        : QuadratisedContacts(laws, theta, levels, variant) {}
    bool centred() const override { return in_the_middle; }
};

}  // namespace jvari
