// Free masses in the form that the references use. Each mass is one more mode with frequency 0,
// behind the string's modes. All modes there share one modal mass m. A displacement q of the mode
// moves a mass M by share q, with share = sqrt(m/M). The mass's contact reads the string's
// footprint minus that displacement.
#pragma once

#include <vector>

#include "scenes/modes.hpp"
#include "scenes/start.hpp"

namespace jvari {

Modes with_masses(Modes, const String&);
// The argument is start_of() for the modes without masses.
ModalStart with_masses(ModalStart, const Modes&, const String&);
double share_of(const Modes&, const Mass&);

struct Touched {
    LumpedBarrier law;
    std::vector<double> weights;  // for each mode
};
// Lists the string's barriers, which all are lumped, and its masses. The modes are with_masses().
std::vector<Touched> touched_by(const Modes&, const String&);

}  // namespace jvari
