// Taylor series of the pluck's force (van Walstijn et al. 2016, eqs 14-15), an entire function of
// time; for a file the series of the line on which the window begins.
#pragma once

#include "scenes/scene.hpp"

namespace jvari {

// c[n] = F_e^(n)(start + u) h^n/n! [N], n < count, at the time u >= 0 after the pluck's start, for
// a window of length h [s].
void pluck_series(const Pluck&, double u, double h, int count, double* c);

// Windows this short [s] see the series shrink by 1/8 and more from term to term.
double pluck_window(const Pluck&);

}  // namespace jvari
