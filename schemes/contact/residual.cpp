#include "schemes/contact/residual.hpp"

#include <Eigen/Dense>

namespace jvari {

Residual::Residual(const MissingMatrix& m, double span, int levels)
    : points_(m.points()),
      levels_(levels),
      rate_(1 / span),
      C_(m.C),
      W_(m.C),
      K_(m.C),
      damper_(m.ladder.damper),
      V_(m.ladder.V),
      moved_(points_),
      behind_(points_) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto n = static_cast<Eigen::Index>(points_);
    const auto of = [n](std::vector<double>& x) { return Eigen::Map<Matrix>(x.data(), n, n); };
    Eigen::VectorXd branch(n);
    for (Eigen::Index k = 0; k < n; ++k)
        branch[k] = masses_.emplace_back(m.ladder.mass[k], m.ladder.resistance[k], span).branch;
    const Matrix R = of(damper_) + of(V_).transpose() * branch.asDiagonal() * of(V_);
    const Matrix w = (R * of(C_) / span + 0.5 * Matrix::Identity(n, n)).inverse(), k = of(C_) * w;
    of(W_) = w;  // (3)
    of(K_) = 0.5 * (k + k.transpose());
    for (State& s : state_)
        for (auto* x : {&s.P, &s.v, &s.D, &s.Q, &s.H}) x->assign(points_, 0.0);
    steady_.assign(points_, 0.0);
}

}  // namespace jvari
