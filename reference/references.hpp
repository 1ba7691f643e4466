// The references, in order of authority. Each is a Scheme with an error bound, made and stepped like any other.
#pragma once

#include <span>

#include "schemes/scheme.hpp"

namespace jvari {

extern const Descriptor exact_linear, characteristic_lattice, exact_contact, sundials;

std::span<const Descriptor> references();

// The first reference that represents the scene, or nullptr.
const Descriptor* best_reference(const Scene&);

}  // namespace jvari
