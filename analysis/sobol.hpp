// Sobol points, each coordinate shifted by a seeded amount, modulo 1 (Cranley & Patterson 1976).
// The points stay equally even, and another seed gives others.
#pragma once

#include <cstdint>
#include <vector>

namespace jvari {

constexpr int most_dimensions = 40;  // GSL's limit

// `number` points in [0, 1)^dimensions. The same arguments give the same bits on every machine.
std::vector<std::vector<double>> sobol_points(int dimensions, int number, std::uint64_t seed);

}  // namespace jvari
