// Force of a pluck, and bounds on the string motion that a scene's energy allows.
#pragma once

#include <optional>

#include "scenes/scene.hpp"

namespace jvari {

// F_e(t) [N]   (van Walstijn et al. 2016, eqs 14-15); a file's force is linear between its rows; 0
// outside [start, start + duration]
double force(const Pluck&, double t);

// Mean of F_e over the step from t to t + dt, and 3 times the integral of F_e (2s - 1) over the
// relative time s = 0 .. 1, so that F_e is about mean + moment (2s - 1) [N]. Both are exact for a
// file and hold to 1e-12 of a_e for (14). A step may contain the whole pluck.
double mean_force(const Pluck&, double t, double dt);
double first_moment(const Pluck&, double t, double dt);
// Mean over the two steps that meet at t, weighted by 1 - |t' - t|/dt. Under this force a mass
// stepped by its central difference moves as under F_e. At t = 0 the mean covers the first step
// alone. Times dt, the means at all levels (half the first one and all others) add up to the
// impulse.
double mean_about(const Pluck&, double t, double dt);

// Row in a file's force at which the line about the instant t begins.
std::size_t line_at(const Pluck&, double t);

// First instant [s] after t at which the force changes to another function: the pluck's start and
// end, and each row in a file; infinite if there is none.
double next_knot(const Pluck&, double t);

// Instant [s] from which on a force from a file does not change until the instant `until`, for
// example a side load; nothing if it changes or ends.
std::optional<double> steady_from(const Pluck&, double until);

// Instant [s] at which all error windows begin: the end of the last pluck that begins before the
// scene ends, because every model moves alike while a finger holds the string; the start of a blow;
// for a force that lasts, where it is steady. 0 without a pluck.
double free_from(const Scene&);

// Coefficient of sin(beta x) [m] in the smoothed triangle: 2AL^2/(i^2 pi^2 x0 (L-x0)) sin(beta x0)
// H(beta)
double coefficient(const TriangleShape&, double length, int mode);

// H(beta) = [sin(beta s/2)/(beta s/2)]/[1 - (beta s/2 pi)^2]: spectrum of a Hann window with full
// width s, 1/2 at beta s = 2 pi
double hann_smoothing(double beta, double s);

// ---- Bounds on the motion from a scene's energy: a run far beyond them has diverged, whether or
// not its scheme reports an energy.

// Upper bound on the energy [J] that strings, threads, barriers and masses hold at t = 0 and plucks
// can supply. Consider modes i of the string, from rest, and a force F with the static compliance C
// at its point. Integrating F by parts bounds the energy by C (max|F| + integral of |F'|)^2/2 at
// any time, so by 2 C a_e^2 for a pluck (it rises to a_e and falls to 0). Contacts, threads and
// losses only take energy away. Infinite if a rigid barrier is penetrated, or if a body moves the
// strings' end.
double available_energy(const Scene&, int modes);

// Largest value of each tap that this energy allows on a string with this many modes. The bound is
// sqrt(2 E sum of w_i^2/(m omega_i^2)) if the tap is the sum of w_i y_i, and sqrt(2 E sum of
// w_i^2/m) if it is the sum over the velocities. Infinite if unknown, for example for contact
// forces. A scheme with aliasing modes exceeds the bound.
std::vector<double> tap_bounds(const Scene&, int modes);

}  // namespace jvari
