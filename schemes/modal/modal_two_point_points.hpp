// The modal two-point scheme of a string that meets its obstacle at several points: modal_two_point_points.cpp.
#pragma once

#include <memory>

#include "schemes/scheme.hpp"

namespace jvari {

struct TwoPointCoefficients {  // of one mode (van Walstijn et al. 2016, eqs 32-33)
    double A, B;
};
using TwoPointLaw = TwoPointCoefficients (*)(double omega0, double sigma, double dt);

// Profiles touch at points of their own (option `points`). Contact loss with compliance=own alone.
std::unique_ptr<Scheme> modal_two_point_points(const Descriptor&, const Scene&, const Settings&, TwoPointLaw);

}  // namespace jvari
