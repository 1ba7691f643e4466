// Doubles on a 64-byte boundary, for fast vector loads.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace jvari {

constexpr std::align_val_t line_alignment{64};  // [bytes]

template <class T>
struct LineAllocator {
    using value_type = T;
    LineAllocator() = default;
    template <class U>
    LineAllocator(const LineAllocator<U>&) {}
    T* allocate(std::size_t n) {
        return static_cast<T*>(::operator new(n * sizeof(T), line_alignment));
    }
    void deallocate(T* p, std::size_t) { ::operator delete(p, line_alignment); }
    bool operator==(const LineAllocator&) const = default;
};

using AlignedVector = std::vector<double, LineAllocator<double>>;

}  // namespace jvari
