// The references, in order of authority. Each is a Scheme with an error bound, made and stepped
// like any other.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "schemes/making.hpp"

namespace jvari {

extern const Descriptor exact_linear, characteristic_lattice, exact_contact, sundials;

std::span<const Descriptor> references();

// Those that represent the scene, and the first of them or nullptr.
std::vector<const Descriptor*> references_of(const Scene&);
const Descriptor* best_reference(const Scene&);

// The options with compliance=matched, which is nearer to the scene with the same modes: where it
// says something and nobody chose another. Nothing where it does not. The reference may refuse it
// still.
std::optional<OptionValues> matched(const Descriptor& reference, const Scene&, OptionValues);
bool is_matched(const OptionValues&);

}  // namespace jvari
