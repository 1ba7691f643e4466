#include "schemes/contact/residual.hpp"

#include <Eigen/Dense>

namespace jvari {

Residual::Residual(const MissingMatrix& m, double span_) : points(m.ladder.size()), C(m.C), W(m.C), K(m.C), ladder(m.ladder), span(span_) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto n = static_cast<Eigen::Index>(points);
    const Eigen::Map<const Matrix> c(C.data(), n, n);
    Eigen::VectorXd r(n);
    for (Eigen::Index a = 0; a < n; ++a) r[a] = ladder[a].resists(2 / span);
    const Matrix w = (r.asDiagonal() * c / span + 0.5 * Matrix::Identity(n, n)).inverse(), k = c * w;
    Eigen::Map<Matrix>(W.data(), n, n) = w;
    Eigen::Map<Matrix>(K.data(), n, n) = 0.5 * (k + k.transpose());
}

ResidualPair::ResidualPair(const MissingMatrix& m, double span) {
    const bool contact = m.contacts > 0;
    if (contact) C_bb = m.C.front(), b_ = LadderStep(m.ladder.front(), span);
    if (m.thread) C_cc = m.C.back(), c_ = LadderStep(m.ladder.back(), span);
    if (contact && m.thread) C_bc = m.C[1];
    if (contact && !m.pluck.empty()) C_be = m.pluck.front();
    if (m.thread && !m.pluck.empty()) C_ce = m.pluck.back();
    const double R_b = (b_.damper + b_.branch) / span, R_c = (c_.damper + c_.branch) / span;
    const double bb = R_b * C_bb + 0.5, bc = R_b * C_bc, cb = R_c * C_bc, cc = R_c * C_cc + 0.5, det = bb * cc - bc * cb;
    W_bb = cc / det, W_bc = -bc / det, W_cb = -cb / det, W_cc = bb / det;
    K_bb = C_bb * W_bb + C_bc * W_cb;
    K_bc = C_bb * W_bc + C_bc * W_cc;
    K_cc = C_bc * W_bc + C_cc * W_cc;
    const double stiff = C_bb * C_cc - C_bc * C_bc;
    if (stiff > 0) stiff_bb = C_cc / stiff, stiff_bc = -C_bc / stiff, stiff_cc = C_bb / stiff;
    else if (C_bb > 0) stiff_bb = 1 / C_bb;
    else if (C_cc > 0) stiff_cc = 1 / C_cc;
}

}  // namespace jvari
