// A string's free masses as its references have them. Each is one more mode, of frequency 0 and
// behind those of the string. As all modes there have one modal mass m, that of a mass M moves it
// by share q, share = sqrt(m/M). Its contact reads the string's footprint less that.
#pragma once

#include <vector>

#include "scenes/modes.hpp"
#include "scenes/start.hpp"

namespace jvari {

Modes with_masses(Modes, const String&);
// of start_of() for the modes without them
ModalStart with_masses(ModalStart, const Modes&, const String&);
double share_of(const Modes&, const Mass&);

struct Touched {
    LumpedBarrier law;
    std::vector<double> weights;  // of each mode
};
// the string's barriers, which all are lumped, and its masses; the modes are with_masses()
std::vector<Touched> touched_by(const Modes&, const String&);

}  // namespace jvari
