// A response as second-order sections side by side: no delay, and little to remember. Convolution in blocks of 512 costs less.
//
// Source: Bank, "Perceptually motivated audio equalization using fixed-pole parallel second-order filters", IEEE SPL 15, 2008, eqs 1-5 and
// 8-10. The poles stand on a logarithmic scale of frequency, their damping such that neighbours meet at -3 dB; what is linear is solved
// by least squares, reluctant to large gains that cancel each other. In terms of z^-1:
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

// Of `count` sections between `lowest` [Hz] and nine tenths of half the rate. Throws std::invalid_argument unless count >= 1, the response
// has at least 2 count + 1 rows, and rate > 4 lowest.
Resonators resonators_for(std::span<const double> response, double rate, int count, double lowest = 50);

std::vector<double> filtered(const Resonators&, std::span<const double> signal);  // from silence; as many rows

// The energy of what the response of the sections differs by, of that of the response [dB]: -20 is a tenth of its root mean square.
double misfit_db(const Resonators&, std::span<const double> response);

}  // namespace jvari
