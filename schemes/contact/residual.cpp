#include "schemes/contact/residual.hpp"

#include <Eigen/Dense>

namespace jvari {

Residual::Residual(const MissingMatrix& m, double span)
    : points(m.points()), C(m.C), W(m.C), K(m.C), damper(m.ladder.damper), V(m.ladder.V) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto n = static_cast<Eigen::Index>(points);
    const auto of = [n](std::vector<double>& x) { return Eigen::Map<Matrix>(x.data(), n, n); };
    Eigen::VectorXd branch(n);
    for (Eigen::Index k = 0; k < n; ++k)
        branch[k] = masses.emplace_back(m.ladder.mass[k], m.ladder.resistance[k], span).branch;
    const Matrix R = of(damper) + of(V).transpose() * branch.asDiagonal() * of(V);
    const Matrix w = (R * of(C) / span + 0.5 * Matrix::Identity(n, n)).inverse(), k = of(C) * w;
    of(W) = w;
    of(K) = 0.5 * (k + k.transpose());
}

ResidualPair::ResidualPair(const MissingMatrix& m, double span) {
    const Residual of(m, span);
    const bool contact = m.contacts > 0, both = contact && m.thread;
    if (contact) C_bb = of.C[0], K_bb = of.K[0], W_bb = of.W[0], damper_bb = of.damper[0];
    if (m.thread) K_cc = of.K.back(), W_cc = of.W.back(), damper_cc = of.damper.back();
    if (both) K_bc = of.K[1], W_bc = of.W[1], W_cb = of.W[2], damper_bc = of.damper[1];
    if (contact && !m.pluck.empty()) C_be = m.pluck.front();
    if (m.thread && !m.pluck.empty()) C_ce = m.pluck.back();
    for (std::size_t k = 0; k < of.points; ++k) {
        m_[k] = of.masses[k];
        if (contact) b_[k] = of.V[k * of.points];
        if (m.thread) c_[k] = of.V[(k + 1) * of.points - 1];
    }
    const double C_bc = both ? of.C[1] : 0, C_cc = m.thread ? of.C.back() : 0,
                 det = C_bb * C_cc - C_bc * C_bc;
    if (det > 0) stiff_bb = C_cc / det, stiff_bc = -C_bc / det, stiff_cc = C_bb / det;
    else if (C_bb > 0) stiff_bb = 1 / C_bb;
    else if (C_cc > 0) stiff_cc = 1 / C_cc;
}

}  // namespace jvari
