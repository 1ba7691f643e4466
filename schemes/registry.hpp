// The table of schemes: those of this tree, then those that plugins bring.
#pragma once

#include <span>

#include "schemes/plugin.hpp"

namespace jvari {

std::span<const Descriptor> schemes();  // in-tree schemes

// Loads a shared object; its schemes stay loaded until the process ends. Throws std::runtime_error with the reason.
const Plugin& load_plugin(const std::string& path);

struct LoadedPlugin {
    std::string path;
    const Plugin* plugin;
};
std::span<const LoadedPlugin> loaded_plugins();  // in the order in which they came; to be asked between loads

}  // namespace jvari
