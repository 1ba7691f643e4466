// Convolution with a long response, one block at a time, by uniformly partitioned overlap-save
// (Stockham 1966).
//
// out[n] = sum_m response[m] in[n - m], where `in` is 0 before the first row. A block costs two
// transforms of 2 `block` rows, and a product of spectra for each partition of the response. Only
// the constructor allocates memory.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace jvari {

class Convolution {
public:
    // Throws std::invalid_argument for an empty response or block < 1.
    Convolution(std::span<const double> response, int block);
    ~Convolution();
    Convolution(Convolution&&) noexcept;

    int block() const;  // rows in a block
    // each has `block` rows; both may be the same memory
    void advance(std::span<const double> in, std::span<double> out);
    void reset();  // starts again from silence

private:
    struct State;
    std::unique_ptr<State> state_;
};

// Convolves a whole signal; result and signal have equally many rows.
std::vector<double> convolved(std::span<const double> signal, std::span<const double> response);

}  // namespace jvari
