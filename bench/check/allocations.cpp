#include "bench/check/allocations.hpp"

#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define JVARI_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer) || \
    __has_feature(thread_sanitizer)
#define JVARI_SANITIZED
#endif
#endif

// Belongs to the executable, so that its first use allocates nothing.
static thread_local long allocations = 0;

#if defined(JVARI_SANITIZED)
// Declared in sanitizer/allocator_interface.h, which GCC does not install.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*,
                                                                  std::size_t),
                                                         void (*)(const volatile void*));
static void on_malloc(const volatile void*, std::size_t) { ++allocations; }
static void on_free(const volatile void*) {}
static const bool installed = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0;
#elif defined(__GLIBC__)
static const bool installed = true;
// Calls glibc's own allocator under its public alias; operator new and the aligned forms pass
// through these functions too.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): glibc's own names
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
// NOLINTEND(bugprone-reserved-identifier)
void* malloc(std::size_t n) { return ++allocations, __libc_malloc(n); }
void* calloc(std::size_t n, std::size_t m) { return ++allocations, __libc_calloc(n, m); }
void* realloc(void* p, std::size_t n) { return ++allocations, __libc_realloc(p, n); }
void* aligned_alloc(std::size_t a, std::size_t n) { return ++allocations, __libc_memalign(a, n); }
void* memalign(std::size_t a, std::size_t n) { return ++allocations, __libc_memalign(a, n); }
int posix_memalign(void** p, std::size_t a, std::size_t n) {
    if (a % sizeof(void*) != 0 || (a & (a - 1)) != 0 || a == 0) return EINVAL;
    void* block = (++allocations, __libc_memalign(a, n));
    if (!block) return ENOMEM;
    *p = block;
    return 0;
}
}
#else
static const bool installed = false;
#endif

namespace jvari::bench::check {
Allocations::Allocations() : before_(allocations) {}
long Allocations::count() const { return allocations - before_; }
bool Allocations::counted() { return installed; }
}  // namespace jvari::bench::check
