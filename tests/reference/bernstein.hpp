// Finds where a polynomial first becomes negative, by its Bernstein coefficients: on a part of the unit interval its values lie between the
// smallest and the largest coefficient, and one sign change means one root (variation diminishing). Nothing is sampled, so only dips that
// stay above -bound can be missed.
#pragma once

#include "reference/exact/oscillators.hpp"

namespace jvari {

double value(const double* c, int count, double x);  // sum c_n x^n
double slope(const double* c, int count, double x);  // sum n c_n x^(n-1)

// The first x in [0, 1] from which sum c_n x^n is negative, or 2 if there is none. Exactly zero leading coefficients are a root at 0 that
// is known already: what follows it is decided by the first coefficient that is not zero.
double first_negative(const double* c, int count, double bound);

}  // namespace jvari
