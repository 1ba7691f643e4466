// Profiles and the contact law. Penetration eta = h - y [m]; V(eta) = k [eta]^(a+1)/(a+1); the force on the string is V'(eta) >= 0.
#pragma once

#include "scenes/scene.hpp"

namespace jvari {

// g(x) [m] of a profile; a table is interpolated by a GSL monotone cubic (Steffen) spline.
double height(const Curve&, double x);

// The same for many positions at once (a table's spline is made once).
std::vector<double> heights(const Curve&, const std::vector<double>& x);

// Contact modulus E* [Pa] from Young's moduli [Pa] and Poisson's ratios   (van Walstijn et al. 2016, eq 55)
double contact_modulus(double young1, double poisson1, double young2, double poisson2);

// k = pi/4 E* w [N/m] of two parallel cylinders in contact over the width w [m]   (eq 54)
LumpedStiffness contact_stiffness(double contact_modulus, double width);

}  // namespace jvari
