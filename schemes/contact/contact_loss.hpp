// Contacts that lose energy (Hunt-Crossley, Issanchou et al. 2016, eq 24), as obstacle.hpp has
// them: each pulls by D r more, D = beta V'(eta)/span at the level that the step is centred on, and
// the contacts see other compliances while one of them is closed. A clipped loss does not pull:
// where F - D r would, the contact lets go for the step, which is solved as if it were out of
// reach, and what its spring gives is lost.
#pragma once

#include <vector>

#include "schemes/contact/obstacle_rule.hpp"

namespace jvari {

class ContactLoss {
public:
    ContactLoss() = default;
    // theta: between the contacts, the thread eliminated
    ContactLoss(const Contacts&, std::vector<double> theta, double span);

    // D, and with it the compliances and b. False where no lossy contact is closed, and where none
    // loses anything. Allocates nothing.
    bool damp(const BeforeStep& at, double* b) noexcept {
        if (beta_.empty()) return false;
        std::fill(lets_go_.begin(), lets_go_.end(), 0);
        return damp_closed(at, b);
    }
    // Once the step is solved: whether other contacts have to let go of it. Then D, the compliances
    // and b are those of that.
    bool clip(const BeforeStep& at, const double* r, const double* force, double* b) noexcept;
    // eta as the rule is to see it
    const double* older() const { return older_.data(); }
    // The springs' forces become those on the string; r is put right.
    void settle(const BeforeStep& at, double* r, double* force) noexcept;
    double lost() const { return lost_; }  // in the last step [J]

    const std::vector<double>& undamped() const { return theta_; }
    const std::vector<double>& damped() const { return damped_; }

private:
    bool damp_closed(const BeforeStep&, double* b) noexcept;

    std::vector<ContactLaw> laws_;
    std::vector<double> beta_, drag_;     // [s/m], D [N/m]; none where nothing is lost
    std::vector<double> theta_, damped_;  // as it is, and with D
    std::vector<double> root_, across_;   // workspaces: S, X by columns
    ScaledSystem system_;                 // M
    // b without D; by how much the readings miss the forces, on the closed contacts
    std::vector<double> b_, off_, x_;
    std::vector<char> clipped_, lets_go_;
    std::vector<double> older_, aside_;  // aside: b of those that let go
    std::vector<int> closed_;
    double span_ = 1, lost_ = 0;
};

}  // namespace jvari
