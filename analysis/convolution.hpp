// Convolution with a long response, a block at a time: overlap-save over partitions of equal length (Stockham 1966; uniformly partitioned).
//
// out[n] = sum_m response[m] in[n - m], in before the first row 0. Each block costs two transforms of 2 `block` rows and a product of
// spectra per partition of the response. Nothing is allocated once it is made.
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

    int block() const;                                                // rows
    void advance(std::span<const double> in, std::span<double> out);  // `block` rows each; they may be the same
    void reset();                                                     // to silence

private:
    struct State;
    std::unique_ptr<State> state_;
};

// Of a whole signal, as many rows as it has.
std::vector<double> convolved(std::span<const double> signal, std::span<const double> response);

}  // namespace jvari
