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

// References that represent the scene, and the first among them or nullptr.
std::vector<const Descriptor*> references_of(const Scene&);
const Descriptor* best_reference(const Scene&);

// Adds compliance=matched to the options, which is nearer to the scene with the same modes. Returns
// nothing if matching has no effect or if the caller chose another compliance. The reference may
// still refuse the options.
std::optional<OptionValues> matched(const Descriptor& reference, const Scene&, OptionValues);
bool is_matched(const OptionValues&);

}  // namespace jvari
