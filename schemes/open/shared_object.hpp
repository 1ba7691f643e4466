// Loads shared objects: .so, .dylib, .dll.
#pragma once

#include <string>

namespace jvari {

// Loads a file and leaves it loaded. nullptr: it cannot be loaded, and `why` has the system's
// reason.
void* load_shared_object(const std::string& path, std::string& why);

// nullptr: it does not export that name
void* symbol_of(void* shared_object, const char* name);

}  // namespace jvari
