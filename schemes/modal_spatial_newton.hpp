// Full-modal spatial Newton (Issanchou et al. 2016): see modal_spatial_newton.cpp.
#pragma once

#include "schemes/scheme.hpp"

namespace jvari {

extern const Descriptor modal_spatial_newton;

}  // namespace jvari
