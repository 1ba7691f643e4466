// Which of the tree's schemes are controls (schemes.def): known to be wrong somewhere.
#pragma once

#include "schemes/scheme.hpp"

namespace jvari {

bool is_control(const Descriptor&);

}  // namespace jvari
