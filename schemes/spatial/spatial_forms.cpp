// The dense form (Issanchou et al. 2016, eqs 13-15); the restricted one is in spatial_restricted.cpp.
#include "schemes/spatial/spatial_forms.hpp"

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace jvari {

namespace {
using Vector = Eigen::VectorXd;
using In = Eigen::Map<const Vector>;
using Out = Eigen::Map<Vector>;
using Matrix = Eigen::Map<const Eigen::MatrixXd>;

double sine(long numerator, long intervals) {  // sin(pi numerator/intervals)
    long turn = numerator % (2 * intervals);
    const double sign = turn >= intervals ? -1 : 1;
    turn %= intervals;
    return sign * std::sin(std::numbers::pi * double(std::min(turn, intervals - turn)) / double(intervals));
}

// S diag(c) S^-1, S_ij = sin(ij pi/N), S^-1 = (2/N) S:  element ik is t(i-k) - t(i+k), t(q) = (1/N) sum_j c_j cos(qj pi/N).
// In long double: an error common to a diagonal would detune every mode, by 1e-16/(omega dt)^2.
std::vector<double> nodal_matrix(const std::vector<double>& c, int N) {
    const int n = N - 1;
    std::vector<long double> t(2 * N), cosine(2 * N);
    std::vector<double> matrix(static_cast<std::size_t>(n) * n);
    for (long q = 0; q < 2 * N; ++q) cosine[q] = std::cos(std::numbers::pi_v<long double> * q / N);
    for (long q = 0; q < 2 * N; ++q) {
        for (long j = 1; j < N; ++j) t[q] += c[j - 1] * cosine[q * j % (2 * N)];
        t[q] /= N;
    }
    for (int k = 1; k <= n; ++k)
        for (int i = 1; i <= n; ++i) matrix[static_cast<std::size_t>(k - 1) * n + i - 1] = double(t[std::abs(i - k)] - t[i + k]);
    return matrix;
}
}  // namespace

std::vector<double> node_weights(int intervals, int node) {
    std::vector<double> w;
    for (int j = 1; j < intervals; ++j) w.push_back(sine(long(j) * node, intervals));
    return w;
}

double dot(const AlignedVector& weights, const AlignedVector& level) {
    return In(weights.data(), weights.size()).dot(In(level.data(), level.size()));
}

DenseForm::DenseForm(const LinearUpdate& update)
    : size_(update.modes()),
      reads_(update.reads),
      Dt_(nodal_matrix(update.Ct, update.intervals)),
      Kappa_(nodal_matrix(update.kappa, update.intervals)),
      applied_(size_) {
    for (int j = 1; j <= size_; ++j) {
        const auto column = node_weights(update.intervals, j);
        S_.insert(S_.end(), column.begin(), column.end());
    }
    const Matrix S(S_.data(), size_, size_);
    for (const Port& port : update.ports) {
        push_.emplace_back(size_);
        Out(push_.back().data(), size_) = update.gain * (S * In(port.weights.data(), size_));
        reading_.push_back(reading(port.weights));
    }
    levels.displacement = AlignedVector(size_);
    levels.increment = AlignedVector(size_);
}

void DenseForm::start(const double* y, const double* free_increment) {
    const Matrix S(S_.data(), size_, size_);
    Out(levels.displacement.data(), size_) = S * In(y, size_);
    Out(levels.increment.data(), size_) = S * In(free_increment, size_);
}

void DenseForm::read(double* free) const {
    for (int z = 0; z < reads_; ++z) free[z] = dot(reading_[z], levels.displacement) + dot(reading_[z], levels.increment);
}

void DenseForm::advance(const double* force, double* free) {
    Out u(levels.displacement.data(), size_), d(levels.increment.data(), size_), applied(applied_.data(), size_);
    applied = d;
    for (std::size_t z = 0; z < push_.size(); ++z)
        if (force[z] != 0) applied += force[z] * In(push_[z].data(), size_);
    u += applied;
    d.noalias() = Matrix(Dt_.data(), size_, size_) * applied;
    d.noalias() -= Matrix(Kappa_.data(), size_, size_) * u;
    read(free);
}

void DenseForm::to_modal(const AlignedVector& level, double* modal) const {
    Out(modal, size_).noalias() = Matrix(S_.data(), size_, size_) * In(level.data(), size_);
    Out(modal, size_) *= 2.0 / (size_ + 1);
}

AlignedVector DenseForm::reading(const std::vector<double>& modal_weights) const {
    AlignedVector given(size_), w(size_);
    std::copy(modal_weights.begin(), modal_weights.end(), given.data());
    to_modal(given, w.data());  // S^-1 is symmetric
    return w;
}

}  // namespace jvari
