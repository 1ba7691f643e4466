// Finds installed files wherever a package put them:
// in the nearest share/jvari above the file with this code, which is bin/jvari or a Python module.
#pragma once

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#undef near
#undef far
#else
#include <dlfcn.h>
#ifdef __linux__
#include <sys/auxv.h>
#endif
#endif

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace jvari {

#ifdef _WIN32
inline std::filesystem::path file_of_this_code() {
    HMODULE module = nullptr;
    GetModuleHandleExW(
        GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
        reinterpret_cast<LPCWSTR>(&file_of_this_code), &module);
    std::wstring name(1 << 15, 0);  // the longest path that Windows has
    name.resize(GetModuleFileNameW(module, name.data(), static_cast<DWORD>(name.size())));
    return name;
}
#else
inline std::filesystem::path file_of_this_code() {
    Dl_info in{};
    const char* file =
        dladdr(reinterpret_cast<const void*>(&file_of_this_code), &in) ? in.dli_fname : nullptr;
#ifdef AT_EXECFN
    if (!file || *file != '/')
        // path of the program in its call  NOLINTNEXTLINE(performance-no-int-to-ptr)
        file = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
#endif
    return file ? file : "";
}
#endif

// share/jvari/WHAT; an empty path if nothing was installed, as in a build tree.
inline std::filesystem::path installed(const char* what) {
    std::error_code error;
    for (auto at = std::filesystem::canonical(file_of_this_code(), error); at.has_relative_path();
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
