// The table of schemes: those of this tree, then those from outside: of shared objects
// (open/jvari_scheme.h), and whatever a caller adds.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari {

std::span<const Descriptor> schemes();  // in-tree schemes

// Where schemes from outside come from. It stays until the process ends, and so do its schemes.
struct Guest {
    std::string path;  // the file, or what it is called where there is none: "scheme mine"
    std::vector<Descriptor> schemes;
    std::string contents = {};             // what its results depend on, where there is no file
    std::shared_ptr<const void> own = {};  // what the `own` of its schemes points at
    std::string compiler = {}, flags = {};
    bool optimised = true;
};
// in the order in which they came; to be asked between loads
std::span<const Guest* const> guests();
// in the place of one of the same path. Throws std::runtime_error: unfit names
const Guest& add_guest(Guest);
const Guest* find_guest(const std::string& path);

// The guest of that path, else what a shared object brings. Throws std::runtime_error with the
// reason.
const Guest& load_plugin(const std::string& path);

}  // namespace jvari
