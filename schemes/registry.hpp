// The table of schemes: those of this tree, then those that plugins bring.
#pragma once

#include <span>

#include "schemes/scheme.hpp"

namespace jvari {

std::span<const Descriptor> schemes();  // in-tree schemes

// Loads a shared object and returns its schemes; they stay loaded until the process ends. Throws std::runtime_error with the reason.
std::span<const Descriptor> load_plugin(const std::string& path);

}  // namespace jvari
