// Gauss-Legendre quadrature on 0 ... 1.
#pragma once

#include <span>

namespace jvari {

// Fills both spans with nodes, ascending, and their weights; the spans are equally long. Each
// number is right to its last bit but one.
void gauss_legendre(std::span<double> node, std::span<double> weight);

}  // namespace jvari
