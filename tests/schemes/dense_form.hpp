// The step of a three-point string as the paper has it, for all nodes of the grid by full matrices
// (Issanchou et al. 2016, eqs 13-15), in place of kernels/three_point_pass.hpp: nodal
// displacements, D~ and 1 + D~ - D, 2 (N-1)^2 multiply-adds a step.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "schemes/modal/three_point_modes.hpp"
#include "schemes/spatial/spatial_ports.hpp"

namespace jvari {

class DenseForm {
public:
    explicit DenseForm(const LinearUpdate&);
    void start(const double* y, const double* free_increment);
    void read(double* free) const;
    void advance(const double* force, double* free);
    void to_modal(const AlignedVector& level, double* modal) const;
    AlignedVector reading(const std::vector<double>& modal_weights) const;
    Levels levels;

private:
    std::size_t padded() const {
        return (size_ + modal_padding - 1) / modal_padding * modal_padding;
    }
    int size_, reads_;
    std::vector<double> S_, Dt_, Kappa_;         // column-major, size x size
    std::vector<AlignedVector> push_, reading_;  // per port: dt^2/m S g and the reading of g
    std::vector<double> applied_;
};

namespace dense {
using Vector = Eigen::VectorXd;
using In = Eigen::Map<const Vector>;
using Out = Eigen::Map<Vector>;
using Matrix = Eigen::Map<const Eigen::MatrixXd>;

// S diag(c) S^-1, S_ij = sin(ij pi/N), S^-1 = (2/N) S:  element ik is t(i-k) - t(i+k), t(q) = (1/N)
// sum_j c_j cos(qj pi/N). In long double: an error common to a diagonal would detune every mode, by
// 1e-16/(omega dt)^2.
inline std::vector<double> nodal_matrix(const std::vector<double>& c, int N) {
    const int n = N - 1;
    std::vector<long double> t(2 * N), cosine(2 * N);
    std::vector<double> matrix(static_cast<std::size_t>(n) * n);
    for (long q = 0; q < 2 * N; ++q) cosine[q] = std::cos(std::numbers::pi_v<long double> * q / N);
    for (long q = 0; q < 2 * N; ++q) {
        for (long j = 1; j < N; ++j) t[q] += c[j - 1] * cosine[q * j % (2 * N)];
        t[q] /= N;
    }
    for (int k = 1; k <= n; ++k)
        for (int i = 1; i <= n; ++i)
            matrix[static_cast<std::size_t>(k - 1) * n + i - 1] =
                double(t[std::abs(i - k)] - t[i + k]);
    return matrix;
}

inline double dot(const AlignedVector& weights, const AlignedVector& level) {
    return dense::In(weights.data(), weights.size()).dot(dense::In(level.data(), level.size()));
}
}  // namespace dense

inline DenseForm::DenseForm(const LinearUpdate& update)
    : size_(update.modes()),
      reads_(update.reads),
      Dt_(dense::nodal_matrix(update.Ct, update.intervals)),
      Kappa_(dense::nodal_matrix(update.kappa, update.intervals)),
      applied_(size_) {
    for (int j = 1; j <= size_; ++j) {
        const auto column = node_weights(update.intervals, j);
        S_.insert(S_.end(), column.begin(), column.end());
    }
    const dense::Matrix S(S_.data(), size_, size_);
    for (const Port& port : update.ports) {
        push_.emplace_back(size_);
        dense::Out(push_.back().data(), size_) =
            update.gain * (S * dense::In(port.weights.data(), size_));
        reading_.push_back(reading(port.weights));
    }
    levels.displacement = AlignedVector(padded());
    levels.increment = AlignedVector(padded());
}

inline void DenseForm::start(const double* y, const double* free_increment) {
    const dense::Matrix S(S_.data(), size_, size_);
    dense::Out(levels.displacement.data(), size_) = S * dense::In(y, size_);
    dense::Out(levels.increment.data(), size_) = S * dense::In(free_increment, size_);
}

inline void DenseForm::read(double* free) const {
    for (int z = 0; z < reads_; ++z)
        free[z] = dense::dot(reading_[z], levels.displacement) +
                  dense::dot(reading_[z], levels.increment);
}

inline void DenseForm::advance(const double* force, double* free) {
    dense::Out u(levels.displacement.data(), size_), d(levels.increment.data(), size_),
        applied(applied_.data(), size_);
    applied = d;
    for (std::size_t z = 0; z < push_.size(); ++z)
        if (force[z] != 0) applied += force[z] * dense::In(push_[z].data(), size_);
    u += applied;
    d.noalias() = dense::Matrix(Dt_.data(), size_, size_) * applied;
    d.noalias() -= dense::Matrix(Kappa_.data(), size_, size_) * u;
    read(free);
}

inline void DenseForm::to_modal(const AlignedVector& level, double* modal) const {
    dense::Out(modal, size_).noalias() =
        dense::Matrix(S_.data(), size_, size_) * dense::In(level.data(), size_);
    dense::Out(modal, size_) *= 2.0 / (size_ + 1);
}

inline AlignedVector DenseForm::reading(const std::vector<double>& modal_weights) const {
    AlignedVector given(padded()), w(padded());
    std::copy(modal_weights.begin(), modal_weights.end(), given.data());
    to_modal(given, w.data());  // S^-1 is symmetric
    return w;
}

}  // namespace jvari
