// Makes schemes from a shared object (jvari_scheme.h), in the program's own form.
#pragma once

#include <string>

#include "schemes/registry.hpp"

namespace jvari {

Guest open_plugin(const std::string& path);  // throws std::runtime_error with the reason

}  // namespace jvari
