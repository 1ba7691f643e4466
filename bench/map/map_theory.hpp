// Boundaries that are known, for maps to be compared with.
//
//   grid_limit      finite_difference_explicit, finite_difference_theta: the spacing of the grid is the limit's (finite_difference.hpp)
//   penalty_limit   modal_explicit_penalty: the highest root of the string in contact passes z = -1. Without losses and thread
//                       k = m/(dt^2 sum_i g_i^2/(4 cos^2(omega_i dt/2))),
//                   4 m/(dt^2 sum g^2) where all modes are far below half the rate. It is the limit of lasting contact.
//   nyquist         the highest mode's frequency is half the rate
//   equal_shares    modal_impulse_invariant without losses, started in one mode: the gain of true energy that is there once the obstacle
//   has
//                   given every mode the same share of the energy that the scheme conserves (modal_controls.cpp) is what verdict.hpp allows
#pragma once

#include <string>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari {

std::vector<std::string> theories();
bool is_theory(const std::string&);

// Positive on the sound side, 0 on the boundary; NaN where the theory has nothing to say of the scheme.
double theory_margin(const std::string& theory, const Descriptor&, const Scene&, const Settings&);

}  // namespace jvari
