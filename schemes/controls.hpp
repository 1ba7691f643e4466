// Which of the tree's schemes are controls (schemes.def): known to be wrong somewhere.
#pragma once

#include "schemes/scheme.hpp"

namespace jvari {

bool is_control(const Descriptor&);

// Whether a comparison leaves it out unless asked: controls, and on a string that does not stretch
// the schemes of those that do, which then are dearer twins of others.
inline bool left_out_unasked(const Descriptor& d, const Scene& scene) {
    return is_control(d) || (d.represents - needed_by(scene)).has(Feature::tension_modulation);
}

}  // namespace jvari
