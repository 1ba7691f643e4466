// Masses in the form that the references use. Each mass is one more mode behind the string's modes,
// with the frequency and the decay of its spring and damper, 0 without them. All modes there share
// one modal mass m. A displacement q of the mode moves a mass M by share q from rest(), with share
// = sqrt(m/M). The mass's contact reads the string's footprint minus that displacement.
#pragma once

#include <vector>

#include "scenes/modes.hpp"
#include "scenes/start.hpp"

namespace jvari {

Modes with_masses(Modes, const String&);
// The argument is start_of() for the modes without masses.
ModalStart with_masses(ModalStart, const Modes&, const String&);
double share_of(const Modes&, const Mass&);
// Weights [N] of the masses without a spring, as forces on the modes
std::vector<double> falling(const Modes&, const String&);

struct Touched {
    LumpedBarrier law;
    std::vector<double> weights;  // for each mode
};
// Lists the string's barriers, which all are lumped, and its masses. The modes are with_masses().
std::vector<Touched> touched_by(const Modes&, const String&);

}  // namespace jvari
