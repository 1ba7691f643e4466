// Finds installed files wherever a package put them:
// in the nearest share/jvari above the file with this code, which is bin/jvari or a Python module.
#pragma once

#include <dlfcn.h>
#include <sys/auxv.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace jvari {

// share/jvari/WHAT; an empty path if nothing was installed, as in a build tree.
inline std::filesystem::path installed(const char* what) {
    std::error_code error;
    Dl_info in{};
    const char* file =
        dladdr(reinterpret_cast<const void*>(&installed), &in) ? in.dli_fname : nullptr;
    if (!file || *file != '/')
        // as it was called  NOLINTNEXTLINE(performance-no-int-to-ptr)
        file = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
    for (auto at = std::filesystem::canonical(file, error); at.has_relative_path();
         at = at.parent_path())
        if (auto place = at.parent_path() / "share" / "jvari" / what;
            std::filesystem::exists(place, error))
            return place;
    return {};
}

// The names of the .toml files in a folder, sorted; none if there is no such folder.
inline std::vector<std::string> toml_names(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace jvari
