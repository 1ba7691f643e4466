#include "analysis/squared_transform.hpp"

#include <complex>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace jvari {

struct SquaredTransform::State {
    std::vector<double> rows;
    std::vector<std::complex<double>> bins{};
    Eigen::FFT<double> transform{};
};

SquaredTransform::SquaredTransform(int rows) : state_(new State{std::vector<double>(rows)}) {}
SquaredTransform::~SquaredTransform() = default;

std::span<double> SquaredTransform::rows() { return state_->rows; }

void SquaredTransform::write(double* power) {
    state_->transform.fwd(state_->bins, state_->rows);
    for (std::size_t k = 0; k <= state_->rows.size() / 2; ++k)
        power[k] = std::norm(state_->bins[k]);
}

}  // namespace jvari
