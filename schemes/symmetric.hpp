// Eigenvalues of small symmetric matrices. Eigen's solver is compiled once, in symmetric.cpp: it
// takes five seconds.
#pragma once

#include <vector>

namespace jvari {

struct SymmetricParts {
    std::vector<double> value;   // n, rising
    std::vector<double> vector;  // n x n, column k belongs to value k; orthonormal
};
// n x n; of it the lower triangle is read
SymmetricParts symmetric_parts(const std::vector<double>& matrix, int n);

}  // namespace jvari
