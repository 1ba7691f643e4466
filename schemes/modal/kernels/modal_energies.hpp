// The sums over the modes behind the energy columns, each in one pass and compiled once per instruction set.
#pragma once

#include "schemes/modal/kernels/modal_pass.hpp"

namespace jvari {

// What the increment over a step loses and is given: sum D_i s_i^2 and sum g_i s_i, g of the pluck, nullptr: it does not act.
struct ModalSpending {
    double lost = 0, given = 0;
};

// Of the step in hand in the two-point form: s = v + e F. D = B.
ModalSpending two_point_spending(const ModalPass&, const double* D, const double* g_e);

// sum (J v/2 + A x)^2 + A x^2
double two_point_stored(const ModalPass&, const double* J, const double* A);

// Of the step in hand in the three-point form, v' = v - p v - r x + e F: its spending by s = v' + v with D = W p, and the energies of the
// half steps after and before, sum W (den v^2 + r (2x + v)^2) with v' and with -v.
struct ThreePointEnergies {
    ModalSpending spending;
    double after = 0, before = 0;
};
ThreePointEnergies three_point_energies(const ModalPass&, const double* W, const double* den, const double* g_e);

}  // namespace jvari
