// C_true - C_scheme (contact/compliance.hpp) of a scene's one string in its modes.
#pragma once

#include <optional>
#include <span>

#include "scenes/modes.hpp"
#include "scenes/start.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/driver/string_step.hpp"

namespace jvari {

inline constexpr Option matched_options[] = {compliance_option, profile_points_option};

// own: what the scheme makes of 1 N of steady modal force on each mode [m/N]; step: as of
// missing_matrix.
MissingMatrix modal_missing_matrix(const Descriptor&, const Scene&, const Modes&,
                                   std::optional<double> step, std::span<const double> own);

// How much the string's only contact, which is no profile's, yields under a steady force, relative
// to the true string of the same modes.
double relative_compliance(const Modes&, const String&, std::span<const double> own);

// How a scheme's string yields, with what is in series with its points.
Yield yield_of(std::span<const double> own, const std::optional<MissingMatrix>& series);
// Of the points of a string, barriers and thread: their velocities and forces at t = 0.
void put_start(StringPoints&, const String&, const Modes&, const ModalStart&);

}  // namespace jvari
