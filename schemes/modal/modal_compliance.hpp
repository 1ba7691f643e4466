// C_true - C_scheme (contact/compliance.hpp) of one string in its modes, over barrier, thread, pluck and linear taps.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/contact/series_points.hpp"

namespace jvari {

struct ModalCompliance {
    MissingCompliance points;
    std::vector<std::array<double, 3>> taps;  // per tap of the scene: of 1 N at barrier, thread, pluck; 0 for what is no linear tap
};

// own: what the scheme makes of 1 N of steady modal force on each mode [m/N]. Refuses a string that is too soft already.
ModalCompliance modal_compliance(const Descriptor&, const Scene&, const Modes&, std::span<const double> own);

}  // namespace jvari
