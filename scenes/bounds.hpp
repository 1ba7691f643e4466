// What the energy of a scene can make of its string: a run that goes far beyond has diverged, whether its scheme tells an energy or not.
#pragma once

#include "scenes/scene.hpp"

namespace jvari {

// No less than the energy [J] that strings, threads and barriers hold at t = 0 and plucks can supply. Modes i of the string, from rest, and a
// force F with the static compliance C at its point: integrating F by parts, the energy is at most C (max|F| + integral of |F'|)^2/2 at any
// time, so 2 C a_e^2 of a pluck (it rises to a_e and falls to 0). Contacts, threads and losses only take from it. Infinite where a rigid
// barrier is penetrated, or where a body moves the strings' end.
double available_energy(const Scene&, int modes);

// The largest value of each tap that this energy allows to a string of so many modes, sqrt(2 E sum of w_i^2/(m omega_i^2)), where the tap is
// the sum of w_i y_i, and sqrt(2 E sum of w_i^2/m), where it is that of the velocities. Infinite where it is unknown, as of contact forces.
std::vector<double> tap_bounds(const Scene&, int modes);

}  // namespace jvari
