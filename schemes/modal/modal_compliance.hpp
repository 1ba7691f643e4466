// Computes C_true - C_scheme (contact/compliance.hpp) for the only string in a scene, in its modes.
#pragma once

#include <optional>
#include <span>

#include "scenes/modes.hpp"
#include "scenes/start.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/driver/string_step.hpp"

namespace jvari {

inline constexpr Option matched_options[] = {compliance_option, profile_points_option};

// own: the scheme's displacement under 1 N steady modal force on each mode [m/N]; step: see
// missing_matrix.
MissingMatrix modal_missing_matrix(const Descriptor&, const Scene&, const Modes&,
                                   std::optional<double> step, std::span<const double> own);

// Yield of the string's only contact, which must not belong to a profile, under a steady force,
// relative to the true string with the same modes.
double relative_compliance(const Modes&, const String&, std::span<const double> own);

// Yield of a scheme's string, including the compliance in series with its points.
Yield yield_of(std::span<const double> own, const std::optional<MissingMatrix>& series);
// Sets velocities and forces at t = 0 for the string's points, barriers and thread.
void put_start(StringPoints&, const String&, const Modes&, const ModalStart&);

}  // namespace jvari
