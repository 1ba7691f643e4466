// Boundaries that are known, for maps to be compared with: those that schemes state as their limit (Descriptor::limit), and
//
//   nyquist         the highest mode's frequency is half the rate
//
// Of the schemes in the program:
//   grid_limit      the spacing of the grid is the least that is stable (finite_difference.hpp)
//   penalty_limit   the highest root of the string in lasting contact passes z = -1 (modal_controls.cpp)
//   equal_shares    without losses, started in one mode: the gain of true energy that is there once the obstacle has given every mode the
//                   same share of the energy that the scheme conserves is what verdict.hpp allows (modal_controls.cpp)
#pragma once

#include <string>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari::bench::map {

std::vector<std::string> theories();
bool is_theory(const std::string&);

// For which motion it holds: "lasting contact: where the string parts from the barrier the boundary is elsewhere".
std::string motion_of(const std::string& theory);

// Positive on the sound side, 0 on the boundary; NaN where the theory has nothing to say of the scheme.
double theory_margin(const std::string& theory, const Descriptor&, const Scene&, const Settings&);

}  // namespace jvari::bench::map
