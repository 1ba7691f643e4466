// Profiles and the contact law. Penetration eta = h - y [m]; V(eta) = k [eta]^(a+1)/(a+1); the
// force on the string is V'(eta) >= 0.
#pragma once

#include <functional>

#include "scenes/scene.hpp"

namespace jvari {

// Height g(x) [m] of a profile. Between its rows a table is interpolated by monotone cubics
// (Steffen 1990).
double height(const Curve&, double x);

// Heights at many positions; the spline through a table is computed once.
std::vector<double> heights(const Curve&, const std::vector<double>& x);

// Grid nodes first, first + 1, ... at spacing L/intervals that lie on a profile, without the
// string's ends; x [m] is their place. A node counts on the end of the profile if both agree to
// within near_node of the string's length, because both are rounded.
constexpr double near_node = 1e-9;
struct ProfileNodes {
    int first;
    std::vector<double> x;
};
ProfileNodes nodes_on(const ProfileBarrier&, double length, int intervals);

// Replaces a profile by point contacts at each x [m], each with the profile's stiffness over
// `spacing` [m]; or in the middles of this many equal parts.
std::vector<LumpedBarrier> lumped(const ProfileBarrier&, const std::vector<double>& x,
                                  double spacing);
std::vector<LumpedBarrier> lumped(const ProfileBarrier&, int parts);

// Returns the string's barriers, with points in place of each profile.
using PointsOf = std::function<std::vector<LumpedBarrier>(const ProfileBarrier&)>;
std::vector<Barrier> without_profiles(const String&, const PointsOf&);

// Contact modulus E* [Pa] from Young's moduli [Pa] and Poisson's ratios   (van Walstijn et al.
// 2016, eq 55)
double contact_modulus(double young1, double poisson1, double young2, double poisson2);

// k = pi/4 E* w [N/m] for two parallel cylinders in contact over the width w [m]   (eq 54)
LumpedStiffness contact_stiffness(double contact_modulus, double width);

// Contact loss beta [s/m] by which a free body that comes in at `speed` [m/s] leaves at
// `restitution` times this speed, whatever its mass, the stiffness and the exponent.
double loss_for_rebound(double restitution, double speed);

}  // namespace jvari
