// Approximates a response by parallel second-order sections. They add no delay and have little state; convolution in blocks of 512 is
// faster.
//
// Source: Bank, "Perceptually motivated audio equalization using fixed-pole parallel second-order filters", IEEE SPL 15, 2008, eqs 1-5 and
// 8-10. The poles are spaced logarithmically in frequency, and damped so that neighbours meet at -3 dB. The linear coefficients follow from
// least squares, with a penalty on large gains that cancel each other:
//     H = d + sum_k (b0_k + b1_k z^-1)/(1 + a1_k z^-1 + a2_k z^-2)
#pragma once

#include <span>
#include <vector>

namespace jvari {

struct Section {
    double b0 = 0, b1 = 0, a1 = 0, a2 = 0;
};
struct Resonators {
    double direct = 0;
    std::vector<Section> sections;
};

// Fits `count` sections between `lowest` [Hz] and nine tenths of half the rate. Throws std::invalid_argument unless count >= 1, the
// response has at least 2 count + 1 rows, and rate > 4 lowest.
Resonators resonators_for(std::span<const double> response, double rate, int count, double lowest = 50);

std::vector<double> filtered(const Resonators&,
                             std::span<const double> signal);  // starts from silence; the result has as many rows as the signal

// Energy of the difference between the sections' response and the true one, relative to the true one [dB]: -20 dB is a tenth in rms.
double misfit_db(const Resonators&, std::span<const double> response);

}  // namespace jvari
