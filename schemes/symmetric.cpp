#include "schemes/symmetric.hpp"

#include <Eigen/Eigenvalues>

namespace jvari {

SymmetricParts symmetric_parts(const std::vector<double>& matrix, int n) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        Eigen::Map<const Eigen::MatrixXd>(matrix.data(), n, n));
    const Eigen::VectorXd& values = solver.eigenvalues();
    const Eigen::MatrixXd& vectors = solver.eigenvectors();
    return {{values.begin(), values.end()}, {vectors.data(), vectors.data() + vectors.size()}};
}

}  // namespace jvari
