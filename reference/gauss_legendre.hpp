// Gauss-Legendre quadrature on 0 ... 1.
#pragma once

#include <span>

namespace jvari {

// Fills in as many nodes, ascending, and weights as the spans hold, which are equally long. Each is
// right to its last bit but one.
void gauss_legendre(std::span<double> node, std::span<double> weight);

}  // namespace jvari
