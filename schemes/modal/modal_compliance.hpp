// C_true - C_scheme (contact/compliance.hpp) of a scene's one string in its modes.
#pragma once

#include <span>

#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"

namespace jvari {

inline constexpr Option matched_options[] = {compliance_option, profile_points_option};

// own: what the scheme makes of 1 N of steady modal force on each mode [m/N]; dt: its step, 0 if it
// is exact in time.
MissingMatrix modal_missing_matrix(const Descriptor&, const Scene&, const Modes&, double dt,
                                   std::span<const double> own);

// How much the string's only contact, which is lumped, yields under a steady force, relative to the
// true string of the same modes.
double relative_compliance(const Modes&, const String&, std::span<const double> own);

}  // namespace jvari
