#include "schemes/open/shared_object.hpp"

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#undef near
#undef far

#include <filesystem>
#include <system_error>
#else
#include <dlfcn.h>
#endif

namespace jvari {

#ifdef _WIN32
void* load_shared_object(const std::string& path, std::string& why) {
    std::error_code error;
    const HMODULE library = LoadLibraryW(std::filesystem::absolute(path, error).c_str());
    if (!library) why = std::system_category().message(static_cast<int>(GetLastError()));
    return library;
}

void* symbol_of(void* shared_object, const char* name) {
    return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(shared_object), name));
}
#else
void* load_shared_object(const std::string& path, std::string& why) {
    void* library =
        dlopen(path.find('/') == std::string::npos ? ("./" + path).c_str() : path.c_str(),
               RTLD_NOW | RTLD_LOCAL);
    if (!library) why = dlerror();
    return library;
}

void* symbol_of(void* shared_object, const char* name) { return dlsym(shared_object, name); }
#endif

}  // namespace jvari
