// Lists the controls among the tree's schemes (schemes.def): schemes known to be wrong somewhere.
#pragma once

#include "schemes/scheme.hpp"

namespace jvari {

bool is_control(const Descriptor&);

// Tells whether a comparison leaves the scheme out unless asked for it. Controls are left out. On a
// string that does not stretch, schemes for stretching strings are left out too, because there they
// are slower twins of other schemes.
inline bool left_out_unasked(const Descriptor& d, const Scene& scene) {
    return is_control(d) || (d.represents - needed_by(scene)).has(Feature::tension_modulation);
}

}  // namespace jvari
