// Row: a std::vector of doubles that starts on a cache line, for passes with vector instructions.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace jvari {

template <class T>
struct CacheLine {
    using value_type = T;
    CacheLine() = default;
    template <class U>
    CacheLine(const CacheLine<U>&) {}  // NOLINT: allocators convert
    T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
    void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
    friend bool operator==(const CacheLine&, const CacheLine&) { return true; }
};

using Row = std::vector<double, CacheLine<double>>;

}  // namespace jvari
