// Profiles and the contact law. Penetration eta = h - y [m]; V(eta) = k [eta]^(a+1)/(a+1); the force on the string is V'(eta) >= 0.
#pragma once

#include "scenes/scene.hpp"

namespace jvari {

// g(x) [m] of a profile; between its rows a table is monotone cubics (Steffen 1990).
double height(const Curve&, double x);

// The same for many positions at once (a table's spline is made once).
std::vector<double> heights(const Curve&, const std::vector<double>& x);

// The nodes first, first + 1, ... of a grid of L/intervals that lie on a profile, the string's ends left out; x [m], on the profile. An end
// of the profile that is a node to within near_node of the string's length is on it: both are rounded.
constexpr double near_node = 1e-9;
struct ProfileNodes {
    int first;
    std::vector<double> x;
};
ProfileNodes nodes_on(const ProfileBarrier&, double length, int intervals);

// The middles [m] of count equal parts of a profile.
std::vector<double> middles(const ProfileBarrier&, int count);

// A profile as point contacts: one at each x [m], of the stiffness that it has over the given spacing [m].
std::vector<LumpedBarrier> lumped(const ProfileBarrier&, const std::vector<double>& x, double spacing);

// Contact modulus E* [Pa] from Young's moduli [Pa] and Poisson's ratios   (van Walstijn et al. 2016, eq 55)
double contact_modulus(double young1, double poisson1, double young2, double poisson2);

// k = pi/4 E* w [N/m] of two parallel cylinders in contact over the width w [m]   (eq 54)
LumpedStiffness contact_stiffness(double contact_modulus, double width);

}  // namespace jvari
