// A fixed-size array of doubles on a 64-byte boundary, zero at first: what vector loads want.
#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace jvari {

class AlignedVector {
public:
    AlignedVector() = default;
    explicit AlignedVector(std::size_t size) : size_(size), data_(new (std::align_val_t(64)) double[size]()) {}
    double* data() { return data_.get(); }
    const double* data() const { return data_.get(); }
    std::size_t size() const { return size_; }

private:
    struct Free {
        void operator()(double* p) const { ::operator delete[](p, std::align_val_t(64)); }
    };
    std::size_t size_ = 0;
    std::unique_ptr<double[], Free> data_;
};

}  // namespace jvari
