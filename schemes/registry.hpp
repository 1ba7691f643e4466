// Table of schemes: first the schemes of this tree, then schemes from outside, which come from
// shared objects (open/jvari_scheme.h) or are added by a caller.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari {

std::span<const Descriptor> schemes();  // in-tree schemes

// Source of schemes from outside. The guest and its schemes stay until the process ends.
struct Guest {
    std::string path;  // the file, or a name if there is no file: "scheme mine"
    std::vector<Descriptor> schemes;
    std::string contents = {};             // determines the results, if there is no file
    std::shared_ptr<const void> own = {};  // target of its schemes' `own` pointers
    std::string compiler = {}, flags = {};
    bool optimised = true;
};
// In arrival order. Call this only between loads.
std::span<const Guest* const> guests();
// Replaces a guest with the same path. Throws std::runtime_error: unfit names
const Guest& add_guest(Guest);
const Guest* find_guest(const std::string& path);

// Returns the guest with this path, or else loads the shared object. Throws std::runtime_error with
// the reason.
const Guest& load_plugin(const std::string& path);

}  // namespace jvari
