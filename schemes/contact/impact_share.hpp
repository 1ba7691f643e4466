// How much of what a contact gives the string comes as impacts: the share of its impulse within one period of 20 kHz of its closing.
//
// A compliance in series stands for modes that were cut off. It yields as they do under a steady force. What changes within one of their
// periods they answer by carrying energy away, and that no spring does.
#pragma once

#include <cmath>

namespace jvari {

class ImpactShare {
public:
    static constexpr double window = 50e-6;  // [s]

    ImpactShare() = default;
    explicit ImpactShare(double dt) : steps_(static_cast<long>(std::ceil(window / dt))) {}
    void clear() { all_ = sudden_ = 0, since_ = 0; }
    double value() const { return all_ > 0 ? sudden_ / all_ : 0; }
    void join(const ImpactShare& other) {  // of another contact
        all_ += other.all_;
        sudden_ += other.sudden_;
    }

    void take(double force) {  // of the next step; not above 0: the contact is open
        if (!(force > 0)) {
            since_ = 0;
            return;
        }
        all_ += force;
        if (since_ < steps_) sudden_ += force, ++since_;
    }

private:
    double all_ = 0, sudden_ = 0;  // [N]
    long steps_ = 1, since_ = 0;   // the window; steps since the contact closed, of the window
};

}  // namespace jvari
