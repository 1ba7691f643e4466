// All strings of a scene on a body that moves, integrated to a stated tolerance: the reference for
// schemes/body. Between contacts nothing is exact here, and contacts are found by steps short
// enough for root finding to see them (integrator.hpp), which is a belief and not a bound. Leaves
// out: compliance=matched.
#pragma once

#include <memory>

#include "reference/integrator.hpp"

namespace jvari {

std::unique_ptr<Scheme> integrated_instrument(const Descriptor&, const Scene&, const Settings&,
                                              const Integrator::Settings&);

}  // namespace jvari
