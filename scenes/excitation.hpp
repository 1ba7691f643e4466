// The force of a pluck, and the modal amplitudes of initial shapes.
#pragma once

#include "scenes/scene.hpp"

namespace jvari {

// F_e(t) [N]   (van Walstijn et al. 2016, eqs 14-15); 0 outside [start, start + duration]
double force(const Pluck&, double t);

// The instant [s] from which on nothing pushes any more: the end of the last pluck that begins before the scene ends, 0 without one. The
// windows of all errors begin there: while a finger holds the string every model of it moves alike.
double free_from(const Scene&);

// Coefficient of sin(beta x) [m] of the smoothed triangle: 2AL^2/(i^2 pi^2 x0 (L-x0)) sin(beta x0) H(beta)
double coefficient(const TriangleInitial&, double length, int mode);

// H(beta) = [sin(beta s/2)/(beta s/2)]/[1 - (beta s/2 pi)^2]: spectrum of a Hann window of full width s, 1/2 at beta s = 2 pi
double hann_smoothing(double beta, double s);

}  // namespace jvari
