// C_true - C_scheme (contact/compliance.hpp) of a scene's one string in its modes.
#pragma once

#include <span>

#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"

namespace jvari {

// own: what the scheme makes of 1 N of steady modal force on each mode [m/N].
MissingCompliance modal_compliance(const Descriptor&, const Scene&, const Modes&, std::span<const double> own);

}  // namespace jvari
