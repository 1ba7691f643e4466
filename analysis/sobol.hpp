// Points of Sobol's sequence, each coordinate moved by an amount that a seed chooses, modulo 1
// (Cranley & Patterson 1976). The points stay as even as Sobol's, and another seed gives others.
#pragma once

#include <cstdint>
#include <vector>

namespace jvari {

constexpr int most_dimensions = 40;  // of GSL's generator

// `number` points of [0, 1)^dimensions. The same arguments give the same bits on every machine.
std::vector<std::vector<double>> sobol_points(int dimensions, int number, std::uint64_t seed);

}  // namespace jvari
