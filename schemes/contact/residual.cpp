#include "schemes/contact/residual.hpp"

#include "schemes/decompositions.hpp"

namespace jvari {

namespace {
// Matrices are computed in long double and rounded once, because the error of an entry acts in
// every step with the same sign.
using Real = long double;
}  // namespace

Residual::Residual(const MissingMatrix& m, double span, int levels)
    : points_(m.points()),
      levels_(levels),
      rate_(1 / span),
      damper_(m.ladder.damper),
      V_(m.ladder.V),
      steady_(points_),
      Q_(points_),
      before_(2 * static_cast<std::size_t>(points_)) {
    const int n = points_;
    for (int k = 0; k < n; ++k)
        masses_.emplace_back(m.ladder.mass[k], m.ladder.resistance[k], span);
    const std::vector<Real> C(m.C.begin(), m.C.end()), V(V_.begin(), V_.end());
    std::vector<Real> branches(V.size()), R(damper_.begin(), damper_.end());  // V' B
    for (int a = 0; a < n; ++a)
        for (int k = 0; k < n; ++k) branches[a * n + k] = V[k * n + a] * masses_[k].branch;
    const std::vector<Real> resisted = product_of(branches, V, n);
    for (std::size_t i = 0; i < R.size(); ++i) R[i] += resisted[i];
    std::vector<Real> W = product_of(R, C, n);
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) W[a * n + b] = W[a * n + b] / span + (a == b ? 0.5 : 0.0);
    W = inverse_of(W, n);  // (3)
    const std::vector<Real> k = product_of(C, W, n);
    std::vector<Real> K(k.size());
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) K[a * n + b] = (k[a * n + b] + k[b * n + a]) / 2;
    K_.assign(K.begin(), K.end());
    const std::vector<Real> VK = product_of(V, K, n), K_branches = product_of(K, branches, n);
    const auto column = [](std::vector<double>& to, auto&&... rows) {
        (to.push_back(static_cast<double>(rows)), ...);
    };
    for (int b = 0; b < n; ++b) {
        for (int a = 0; a < n; ++a) column(by_force_, W[a * n + b]);  // (5)
        for (int p = 0; p < n; ++p)                                   // (2), (4)
            column(by_force_, masses_[p].share / Real{span} * VK[p * n + b]);
    }
    keeps_.assign(n, 1);
    for (const MassStep& mass : masses_) keeps_.push_back(1 - mass.share);
    for (int b = 0; b < n; ++b) {  // P
        for (int a = 0; a < n; ++a) column(by_state_, m.C[a * n + b]);
        for (int a = 0; a < n; ++a) column(by_state_, K[a * n + b]);
        for (int a = 0; a < n; ++a) column(by_state_, a == b ? 1 : 0);
    }
    for (int p = 0; p < n; ++p) {  // v
        for (int a = 0; a < n; ++a) column(by_state_, 0);
        for (int a = 0; a < n; ++a) column(by_state_, -K_branches[a * n + p]);
        for (int a = 0; a < n; ++a) column(by_state_, -branches[a * n + p]);
    }
    for (State& s : state_) {
        s.x.assign(2 * static_cast<std::size_t>(n), 0.0);
        s.out.assign(3 * static_cast<std::size_t>(n), 0.0);
    }
}

double Residual::lost() const {
    const int n = points_;
    std::vector<double> moved(n);
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) moved[a] += K_[a * n + b] * Q_[b];
    double sum = 0;
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) sum += moved[a] * damper_[a * n + b] * moved[b];
    sum *= rate_;
    for (int k = 0; k < n; ++k) {
        double along = 0;
        for (int b = 0; b < n; ++b) along += V_[k * n + b] * moved[b];
        sum += masses_[k].lost(masses_[k].behind(along, before_[n + k]));
    }
    return sum;
}

}  // namespace jvari
