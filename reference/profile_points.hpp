// Represents a profile barrier by point barriers: the force of a density K [g(x) - y(x)]^alpha on
// mode i (Issanchou et al. 2016, eqs 3-4) is
//
//     int_from^to K [eta(x)]^alpha v_i(x) dx  ~  sum_q w K [eta(x_q)]^alpha v_i(x_q),
//
// by a rule with equal weights, because the touched part ends inside the profile, at a place that
// moves. There are two choices. `count` points in the middles of equally many equal parts approach
// the integral when their number grows. The nodes x_q = qL/N, N = modes + 1, on the grid of
// modal_spatial_newton have its weight L/N: then both have the same equations, and the integration
// error does not enter their comparison.
#pragma once

#include "schemes/scheme.hpp"

namespace jvari {

struct ProfilePoints {
    int count = 0;  // per profile; 0: the grid's nodes
};

constexpr int most_points = 256;  // per string: the references' tables grow with its square

inline constexpr Option nodes_option{"nodes", "32",
                                     "points that stand for a profile: a whole number up to 256, "
                                     "or grid for the nodes of as many modes"};
inline constexpr Approximation points_for_a_profile[] = {
    {Feature::profile_barrier, facts::contact_points}};
ProfilePoints profile_points(const Settings&);

// Replaces the string's profiles. Throws Refusal if they come to no point, or to more than
// most_points.
String with_points(String, int modes, ProfilePoints);

}  // namespace jvari
