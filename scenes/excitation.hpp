// The force of a pluck, and what the energy of a scene can make of its strings.
#pragma once

#include "scenes/scene.hpp"

namespace jvari {

// F_e(t) [N]   (van Walstijn et al. 2016, eqs 14-15), of a file the straight lines between its
// rows; 0 outside [start, start + duration]
double force(const Pluck&, double t);

// The mean of F_e over the step from t to t + dt, and 3 times the integral of F_e (2s - 1) over its
// share s = 0 .. 1, so that F_e is about mean + moment (2s - 1) [N]. A file's are exact, of (14)
// they hold to 1e-12 of a_e. A step may hold the whole pluck.
double mean_force(const Pluck&, double t, double dt);
double first_moment(const Pluck&, double t, double dt);
// The mean over the two steps that meet at t, weighted by 1 - |t' - t|/dt: the force by which a
// mass moves as by F_e when stepped by its central difference. At t = 0 of the first step alone.
// Times dt, the means of all levels add up to the impulse, half of the first one and all others.
double mean_about(const Pluck&, double t, double dt);

// The row of a file's force that the line about the instant t begins at.
std::size_t line_at(const Pluck&, double t);

// The first instant [s] after t at which the force is no longer the same function: the pluck's
// start and end, and each row of a file; infinite where there is none.
double next_knot(const Pluck&, double t);

// The instant [s] from which on nothing pushes any more: the end of the last pluck that begins
// before the scene ends, 0 without one. The windows of all errors begin there: while a finger holds
// the string every model of it moves alike.
double free_from(const Scene&);

// Coefficient of sin(beta x) [m] of the smoothed triangle: 2AL^2/(i^2 pi^2 x0 (L-x0)) sin(beta x0)
// H(beta)
double coefficient(const TriangleShape&, double length, int mode);

// H(beta) = [sin(beta s/2)/(beta s/2)]/[1 - (beta s/2 pi)^2]: spectrum of a Hann window of full
// width s, 1/2 at beta s = 2 pi
double hann_smoothing(double beta, double s);

// ---- What the energy of a scene can make of its strings: a run that goes far beyond has diverged,
// whether its scheme tells an energy or not.

// No less than the energy [J] that strings, threads, barriers and masses hold at t = 0 and plucks
// can supply. Modes i of the string, from rest, and a force F with the static compliance C at its
// point: integrating F by parts, the energy is at most C (max|F| + integral of |F'|)^2/2 at any
// time, so 2 C a_e^2 of a pluck (it rises to a_e and falls to 0). Contacts, threads and losses only
// take from it. Infinite where a rigid barrier is penetrated, or where a body moves the strings'
// end.
double available_energy(const Scene&, int modes);

// The largest value of each tap that this energy allows to a string of so many modes, sqrt(2 E sum
// of w_i^2/(m omega_i^2)), where the tap is the sum of w_i y_i, and sqrt(2 E sum of w_i^2/m), where
// it is that of the velocities. Infinite where it is unknown, as of contact forces. A scheme whose
// modes alias goes beyond it.
std::vector<double> tap_bounds(const Scene&, int modes);

}  // namespace jvari
