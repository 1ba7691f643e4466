// How long a step of a collocated contact may be. A force like eta^alpha is no polynomial where it
// sets in and where it ends, unless alpha is 1. There the error of a step does not fall like that
// of a smooth one:
//   - over a step that begins or ends there the force keeps its shape whatever the length d, and
//   the error is its push, d^(1 + alpha);
//   - over a step at a distance D it was found to be d^(1 + alpha) (d/D)^4, so that lengths grow
//   away from there.
// What is allowed is learnt from the errors and kept from one contact to the next: it hardly
// depends on the speed. Leaves out: what a point's onset does to the forces of others, of order
// alpha + 2, which the errors alone see.
#pragma once

#include <cmath>

namespace jvari {

class ContactSteps {
public:
    ContactSteps(double allowed, double exponent);
    void reset() noexcept { *this = ContactSteps(allowed_, push_ - 1); }

    void set_in() noexcept { since_ = 0; }  // a point touches from here on
    // no longer than `left`; `leaves` from here a force ends, or nowhere
    double next(double left, double leaves) noexcept;
    bool fits(double error) const noexcept { return error <= allowed_; }
    // the step that was asked for, and where it saw a force end
    void rejected(double error, double leaves) noexcept;
    // that step, or a shorter one to a crossing
    void accepted(double error, double d) noexcept;

private:
    enum class Limit { other, edge, grade, smooth };
    double beside(double distance) const noexcept;  // the longest step, at a distance from an onset
    double towards(double leaves) const noexcept;   // and up to such a distance from an end
    void learn(double edge, double grade, double smooth) noexcept;

    double allowed_, push_, by_edge_, by_distance_;  // push_: 1 + alpha
    bool singular_;
    // longest steps: at an onset, of the law beside it, of a smooth force
    double edge_ = 1, grade_ = 4, smooth_ = 1;
    // what follows: of that law, and the distance from which it allows smooth_
    double scale_ = 4, far_ = 0;
    // from the last onset on; the last length, and from its end to a force's
    double since_ = HUGE_VAL, last_ = 1, ended_ = HUGE_VAL;
    bool again_ = false;
    Limit limit_ = Limit::smooth;
};

}  // namespace jvari
