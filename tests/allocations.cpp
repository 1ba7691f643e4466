#include "tests/allocations.hpp"

#include <atomic>
#include <cstddef>

static std::atomic<long> allocations{0};

#if defined(__SANITIZE_ADDRESS__)
// As in sanitizer/allocator_interface.h, which GCC does not install.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t), void (*)(const volatile void*));
static void on_malloc(const volatile void*, std::size_t) {
    ++allocations;
}
static void on_free(const volatile void*) {}
static const int installed = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
#else
// glibc's own allocator under its public alias; operator new and the aligned forms come through here too.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t n) {
    return ++allocations, __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t m) {
    return ++allocations, __libc_calloc(n, m);
}
void* realloc(void* p, std::size_t n) {
    return ++allocations, __libc_realloc(p, n);
}
void* aligned_alloc(std::size_t a, std::size_t n) {
    return ++allocations, __libc_memalign(a, n);
}
}
#endif

namespace jvari {
Allocations::Allocations() : before_(allocations) {}
long Allocations::count() const {
    return allocations - before_;
}
}  // namespace jvari
