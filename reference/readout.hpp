// Reads the taps of a one-string scene from a modal state and from the impulses over the last
// interval.
#pragma once

#include <vector>

#include "scenes/modes.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// in eight partial sums, in a fixed order
double weighted_sum(const double* w, const double* y, int count);

struct Readout {
    Readout(const Scene&, const Modes&);

    void begin(const double* u, double rate, double tap_rate);  // at t = 0, before row 0
    int masses() const { return static_cast<int>(mass_.size()); }

    // Writes row `row` of the block; y [m] and u [m] are modal displacements and velocities/rate;
    // forces are means over the interval [N]. bridge: including masses, whose own share is the
    // change in momentum less the weight, or for a mass on a spring its impulse [N s]
    void write(const Block& out, int row, const double* y, const double* u, double rate,
               double bridge, double thread, const std::vector<double>& impulse = {}) const;

private:
    std::vector<Quantity> quantity_;
    std::vector<int> of_mass_;  // -1: a tap on the string
    std::vector<Mass> mass_;
    std::vector<double> share_;                     // masses.hpp
    mutable std::vector<double> momentum_, force_;  // at the last row [kg m/s]; mean up to it [N]
    double tap_rate_ = 0;
    mutable bool started_ = false;  // a row was written
    std::vector<double> weights_;   // [tap][mode], unused for a contact force
    int modes_;
};

// State from the first modes in padded arrays, whose velocities are `scale` u.
inline ModalState state_of(const std::vector<double>& y, const std::vector<double>& u, int count,
                           double scale) {
    ModalState s{{y.begin(), y.begin() + count}, {u.begin(), u.begin() + count}};
    for (double& v : s.velocity) v *= scale;
    return s;
}

}  // namespace jvari
