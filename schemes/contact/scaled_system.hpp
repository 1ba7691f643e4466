// Factors I + S Theta S over some contacts, with a scale S for each: symmetric and positive
// definite whatever the rank of Theta, which is a Gram matrix. Contact losses, quadratised contacts
// and Newton's steps on several contacts all need this matrix. The factorisation L L' runs column
// by column, which compilers vectorise. It has the speed of Eigen's LLT at any size, without the
// workspace that Eigen allocates from some hundreds on.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace jvari {

class ScaledSystem {
public:
    explicit ScaledSystem(std::size_t most = 0) : factor_(most * most) {}  // contacts

    // theta: between all contacts, row-major, `stride` per row; set: the n selected contacts;
    // scale: for all contacts. False if a pivot is not finite.
    bool factor(const double* theta, int stride, const int* set, int n,
                const double* scale) noexcept {
        size_ = n;
        for (int j = 0; j < n; ++j) {
            const double* row = theta + static_cast<std::ptrdiff_t>(set[j]) * stride;
            for (int i = j; i < n; ++i) column(j)[i] = scale[set[i]] * row[set[i]] * scale[set[j]];
            column(j)[j] += 1;
        }
        for (int j = 0; j < n; ++j) {
            double* L = column(j);
            if (!(L[j] > 0) || !std::isfinite(L[j])) return false;
            L[j] = 1 / std::sqrt(L[j]);  // reciprocal: no division in solve
            for (int i = j + 1; i < n; ++i) L[i] *= L[j];
            for (int k = j + 1; k < n; ++k)
                for (int i = k; i < n; ++i) column(k)[i] -= L[k] * L[i];
        }
        return true;
    }
    void forward(double* x) const noexcept {  // L^-1 x in place, by position in the set
        for (int j = 0; j < size_; ++j) {
            const double* L = column(j);
            x[j] *= L[j];
            for (int i = j + 1; i < size_; ++i) x[i] -= L[i] * x[j];
        }
    }
    void solve(double* x) const noexcept {  // (I + S Theta S)^-1 x likewise
        forward(x);
        for (int j = size_ - 1; j >= 0; --j) {
            const double* L = column(j);
            for (int i = j + 1; i < size_; ++i) x[j] -= L[i] * x[i];
            x[j] *= L[j];
        }
    }

private:
    double* column(int j) { return factor_.data() + static_cast<std::ptrdiff_t>(j) * size_; }
    const double* column(int j) const {
        return factor_.data() + static_cast<std::ptrdiff_t>(j) * size_;
    }
    std::vector<double> factor_;
    int size_ = 0;
};

}  // namespace jvari
