// Products and decompositions for small dense matrices, n x n. Eigen's templates are compiled once,
// in decompositions.cpp: separate copies at each use took two minutes.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace jvari {

struct SymmetricParts {
    std::vector<double> value;   // n, rising
    std::vector<double> vector;  // n numbers for each value, one after another; orthonormal
};
SymmetricParts symmetric_parts(std::span<const double>, int n);

struct Eigenpairs {
    std::vector<std::complex<long double>> value;   // n
    std::vector<std::complex<long double>> vector;  // n numbers for each value, one after another
};
Eigenpairs eigenpairs_of(std::span<const long double>, int n);  // stored by columns

// stored by rows
std::vector<double> product_of(std::span<const double>, std::span<const double>, int n);
std::vector<long double> product_of(std::span<const long double>, std::span<const long double>,
                                    int n);

// stored by rows or by columns, like the matrix
std::vector<double> inverse_of(std::span<const double>, int n);
std::vector<long double> inverse_of(std::span<const long double>, int n);

}  // namespace jvari
