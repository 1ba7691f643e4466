// The schemes of a shared object (jvari_scheme.h), as the program has schemes.
#pragma once

#include <string>

#include "schemes/registry.hpp"

namespace jvari {

Guest open_plugin(const std::string& path);  // throws std::runtime_error with the reason

}  // namespace jvari
