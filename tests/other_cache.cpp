// For other_cache.sh: a machine whose first-level cache holds 48 kB, by LD_PRELOAD.
#include <dlfcn.h>
#include <unistd.h>

extern "C" __attribute__((visibility("default"))) long sysconf(int name) noexcept {
    static const auto real = reinterpret_cast<long (*)(int)>(dlsym(RTLD_NEXT, "sysconf"));
    return name == _SC_LEVEL1_DCACHE_SIZE ? 49152 : real(name);
}
