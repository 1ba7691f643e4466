// The exact three-point recursion of a damped mode, y+ = C y - C~ y- + (dt^2/m) F   (Issanchou et
// al. 2016, eq 14).
//
// C = 2 e^{-sigma dt} cos(omega dt), cosh where overdamped; C~ = e^{-2 sigma dt}. With d+ = y+ - y
// the same reads d+ = C~ d - kappa y + (dt^2/m) F, kappa = 1 + C~ - C,
// and the constants of the energy (eqs 17-18) are (1 + C~)/2, kappa/dt^2, (1 - C~)/dt.
#pragma once

#include <vector>

#include "scenes/modes.hpp"

namespace jvari {

struct ThreePoint {
    double gain = 0;                // dt^2/m [s^2/kg]
    std::vector<double> Ct, kappa;  // C~, and 1 + C~ - C to full relative precision
    std::vector<double> loss;       // 1 - C~
    std::vector<double> start;      // (y^1 - y^0)/y^0 of free motion from rest
    std::vector<double> drift;      // (y^1 - y^0)/v^0 of free motion from y^0 = 0 [s]
    // G [1/s]: v^n = G [2 d+ + (kappa + 1 - C~) y + (dt^2/m) F] - sigma y, d+ without F; exact for
    // F = 0. 0 where three samples do not tell the velocity: near and above the Nyquist frequency
    std::vector<double> velocity;
    // modes whose frequency the sample rate cannot represent: they alias
    int above_nyquist = 0;
};

// `exact_below` bounds omega0 dt of the modes whose velocity is exact. Without contact: 0.95 pi. A
// contact force drives a mode of high omega dt too hard by omega dt/sin(omega dt), which the
// centred difference undoes and G does not: with contact pi/4.
ThreePoint three_point(const Modes&, double dt, double exact_below);

}  // namespace jvari
