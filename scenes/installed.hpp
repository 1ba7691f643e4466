// Where what was installed lies, wherever a package put it: the nearest share/jvari above the file that this code is in, be that bin/jvari
// or a Python module.
#pragma once

#include <dlfcn.h>

#include <filesystem>

namespace jvari {

// share/jvari/WHAT; a path that is none where nothing was installed, as in a build tree.
inline std::filesystem::path installed(const char* what) {
    std::error_code error;
    Dl_info in{};
    std::filesystem::path file = dladdr(reinterpret_cast<const void*>(&installed), &in) && in.dli_fname ? in.dli_fname : "";
    if (!file.is_absolute()) file = std::filesystem::read_symlink("/proc/self/exe", error);  // a program, as it was called
    for (; file.has_relative_path(); file = file.parent_path())
        if (auto place = file.parent_path() / "share" / "jvari" / what; std::filesystem::exists(place, error)) return place;
    return {};
}

}  // namespace jvari
