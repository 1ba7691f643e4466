// Five Strang steps (modal_strang.cpp) in place of one, of lengths g, g, (1 - 4g), g, g times dt with g = 1/(4 - 4^(1/3)), the middle one
// backwards: of order 4 (Suzuki 1990; Hairer, Lubich & Wanner 2006, ch. II.4). Half kicks that meet are one. Here the velocities of the
// modes are kept, as a recursion without them asks for steps of one length.
#pragma once

#include <memory>

#include "schemes/modal/modal_string.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

std::unique_ptr<Scheme> modal_suzuki(const Descriptor&, const Scene&, ModalString);

}  // namespace jvari
