#include "schemes/modal/effective_modes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "schemes/symmetric.hpp"

namespace jvari {

namespace {
constexpr int reach = 30;  // modes in all, over those kept: what lies above answers as a spring, and stands in series with the rest

Eigen::VectorXd tail(const std::vector<double>& w, int from) {
    return Eigen::Map<const Eigen::VectorXd>(w.data() + from, static_cast<Eigen::Index>(w.size()) - from);
}
}  // namespace

ModeBasis::ModeBasis(const String& s, int kept, int effective) : kept_(kept) {
    int total = kept;
    if (effective > 0) {
        const auto* table = std::get_if<TableDamping>(&s.damping);
        total = table ? static_cast<int>(table->frequency_hz.size()) : reach * kept + effective;
    }
    all_ = modes_of(s, total);
    mass = all_.mass;
    omega0.assign(all_.omega0.begin(), all_.omega0.begin() + kept);
    sigma.assign(all_.sigma.begin(), all_.sigma.begin() + kept);
    const int left = total - kept;
    if (std::min(effective, left) <= 0) return;

    std::vector<Eigen::VectorXd> block;
    const auto add = [&](double position, double width) { block.push_back(tail(footprint_weights(all_, position, width), kept)); };
    if (!s.barriers.empty()) {
        const auto& b = std::get<LumpedBarrier>(s.barriers.front());
        add(b.position, b.width);
    }
    if (s.thread) add(s.thread->position, s.thread->width);
    if (block.empty()) return;
    const Eigen::ArrayXd square = tail(all_.omega0, kept).array().square();
    const double unit = square[0];
    Eigen::MatrixXd V(left, std::min(effective, left));
    int n = 0;
    for (std::size_t tried = 0; n < V.cols() && tried < 4 * static_cast<std::size_t>(V.cols()) + block.size(); ++tried) {
        Eigen::VectorXd& x = block[tried % block.size()];
        x = (x.array() * unit / square).matrix();
        Eigen::VectorXd v = x.normalized();
        for (int twice = 0; twice < 2; ++twice) v -= V.leftCols(n) * (V.leftCols(n).transpose() * v);
        if (v.norm() < 1e-10) continue;  // nothing new
        V.col(n++) = v.normalized();
        x = V.col(n - 1);  // the same space, better conditioned
    }
    const Eigen::MatrixXd basis = V.leftCols(n);
    const Eigen::MatrixXd projected = basis.transpose() * square.matrix().asDiagonal() * basis;
    const SymmetricParts ritz = symmetric_parts({projected.data(), projected.data() + projected.size()}, n);
    const Eigen::MatrixXd shapes = basis * Eigen::Map<const Eigen::MatrixXd>(ritz.vector.data(), n, n);
    const Eigen::VectorXd losses = tail(all_.sigma, kept);
    for (int k = 0; k < n; ++k) {
        omega0.push_back(std::sqrt(ritz.value[k]));
        sigma.push_back(shapes.col(k).array().square().matrix().dot(losses));
        shape_.emplace_back(shapes.col(k).data(), shapes.col(k).data() + left);
    }
}

std::vector<double> ModeBasis::reduced(const std::vector<double>& w) const {
    std::vector<double> r(w.begin(), w.begin() + kept_);
    for (const auto& shape : shape_) {
        double sum = 0;
        for (std::size_t i = 0; i < shape.size(); ++i) sum += shape[i] * w[kept_ + i];
        r.push_back(sum);
    }
    return r;
}

}  // namespace jvari
