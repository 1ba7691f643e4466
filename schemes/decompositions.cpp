#include "schemes/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace jvari {

namespace {
template <class Number, int order = Eigen::ColMajor>
using Dense = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, order>;
template <class Number>
using Rows = Dense<Number, Eigen::RowMajor>;

template <class Matrix>
Matrix dense(std::span<const typename Matrix::Scalar> m, int n) {
    return Matrix::Map(m.data(), n, n);
}
template <class Matrix>
std::vector<typename Matrix::Scalar> numbers(const Matrix& m) {
    return {m.data(), m.data() + m.size()};
}
template <class Number>
std::vector<Number> product(std::span<const Number> a, std::span<const Number> b, int n) {
    return numbers(Rows<Number>(dense<Rows<Number>>(a, n) * dense<Rows<Number>>(b, n)));
}
template <class Matrix>
std::vector<typename Matrix::Scalar> inverse(const Matrix& m) {
    return numbers(Matrix(m.inverse()));
}
}  // namespace

SymmetricParts symmetric_parts(std::span<const double> m, int n) {
    const Eigen::SelfAdjointEigenSolver<Dense<double>> solver(dense<Dense<double>>(m, n));
    return {numbers(solver.eigenvalues()), numbers(solver.eigenvectors())};
}

Eigenpairs eigenpairs_of(std::span<const long double> m, int n) {
    const Eigen::EigenSolver<Dense<long double>> solver(dense<Dense<long double>>(m, n));
    return {numbers(solver.eigenvalues()), numbers(solver.eigenvectors())};
}

std::vector<double> product_of(std::span<const double> a, std::span<const double> b, int n) {
    return product(a, b, n);
}
std::vector<long double> product_of(std::span<const long double> a, std::span<const long double> b,
                                    int n) {
    return product(a, b, n);
}

std::vector<double> inverse_of(std::span<const double> m, int n) {
    return inverse(dense<Rows<double>>(m, n));
}
std::vector<long double> inverse_of(std::span<const long double> m, int n) {
    return inverse(dense<Dense<long double>>(m, n));
}

}  // namespace jvari
