#include "schemes/contact/residual.hpp"

#include "schemes/decompositions.hpp"

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
    const std::size_t n = points_;
    for (std::size_t k = 0; k < n; ++k)
        masses_.emplace_back(m.ladder.mass[k], m.ladder.resistance[k], span);
    std::vector<double> R = damper_;
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) {
            double branches = 0;
            for (std::size_t k = 0; k < n; ++k)
                branches += V_[k * n + a] * masses_[k].branch * V_[k * n + b];
            R[a * n + b] += branches;
        }
    std::vector<double> sum = product_of(R, C_, m.points());
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
            sum[a * n + b] = sum[a * n + b] / span + (a == b ? 0.5 : 0.0);
    W_ = inverse_of(sum, m.points());  // (3)
    const std::vector<double> k = product_of(C_, W_, m.points());
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) K_[a * n + b] = 0.5 * (k[a * n + b] + k[b * n + a]);
    for (State& s : state_)
        for (auto* x : {&s.P, &s.v, &s.D, &s.Q, &s.H}) x->assign(points_, 0.0);
    steady_.assign(points_, 0.0);
}

}  // namespace jvari
