// Doubles on a 64-byte boundary: what vector loads want. AlignedVector has a fixed size and is zero at first.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace jvari {

constexpr std::align_val_t line_alignment{64};  // [bytes]

template <class T>
struct LineAllocator {  // of a container that grows
    using value_type = T;
    LineAllocator() = default;
    template <class U>
    LineAllocator(const LineAllocator<U>&) {}
    T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line_alignment)); }
    void deallocate(T* p, std::size_t) { ::operator delete(p, line_alignment); }
    bool operator==(const LineAllocator&) const = default;
};

class AlignedVector {
public:
    AlignedVector() = default;
    explicit AlignedVector(std::size_t size) : size_(size), data_(new (line_alignment) double[size]()) {}
    double* data() { return data_.get(); }
    const double* data() const { return data_.get(); }
    std::size_t size() const { return size_; }

private:
    struct Free {
        void operator()(double* p) const { ::operator delete[](p, line_alignment); }
    };
    std::size_t size_ = 0;
    std::unique_ptr<double[], Free> data_;
};

}  // namespace jvari
