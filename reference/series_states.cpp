#include "reference/series_states.hpp"

#include <cmath>

namespace jvari {

SeriesStates::SeriesStates(const InSeries& series, double mass)
    : count(series.states), points(series.points) {
    for (int i = 0; i < count; ++i)
        width_.push_back(std::sqrt(series.energy[i * count + i] / mass));
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) {
            drift_.push_back(width_[i] * series.A[i * count + j] / width_[j]);
            losing_.push_back(series.loss[i * count + j] / (width_[i] * width_[j]));
        }
    for (int i = 0; i < count; ++i)
        for (int a = 0; a < points; ++a) push_.push_back(width_[i] * series.B[i * points + a]);
    reply_.assign(static_cast<std::size_t>(count + points) * count, 0.0);
    left_.assign(static_cast<std::size_t>(count) * count, 0.0);
}

void SeriesStates::read(const double* w, double* z) const noexcept {
    for (int j = 0; j < count; ++j) z[j] = w[j] / width_[j];
}
void SeriesStates::put(const double* z, double* w) const noexcept {
    for (int j = 0; j < count; ++j) w[j] = z[j] * width_[j];
}

void SeriesStates::speed(const double* w, const double* force, double* out) const noexcept {
    for (int i = 0; i < count; ++i) {
        out[i] = moved(i, w);
        for (int a = 0; a < points; ++a) out[i] += push(i, a) * force[a];
    }
}
double SeriesStates::lost(const double* speed, const double* other) const noexcept {
    double sum = 0;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) sum += speed[i] * losing_[i * count + j] * other[j];
    return sum;
}

void SeriesStates::factor(double gamma) noexcept {
    const int n = count;
    for (int i = 0; i < n * n; ++i) {
        reply_[i] = i % (n + 1) == 0;
        left_[i] = reply_[i] - gamma * drift_[i];
    }
    for (int c = 0; c < n; ++c)  // pivots on the diagonal hold: A decays
        for (int i = 0; i < n; ++i) {
            if (i == c) continue;
            const double factor = left_[i * n + c] / left_[c * n + c];
            for (int j = 0; j < n; ++j) {
                left_[i * n + j] -= factor * left_[c * n + j];
                reply_[i * n + j] -= factor * reply_[c * n + j];
            }
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) reply_[i * n + j] /= left_[i * n + i];
    for (int a = 0; a < points; ++a)
        for (int i = 0; i < n; ++i) {
            double sum = 0;
            for (int j = 0; j < n; ++j) sum += reply_[i * n + j] * push(j, a);
            reply_[(n + a) * n + i] = sum;
        }
}
void SeriesStates::solve(const double* b, double* x) const noexcept {
    for (int i = 0; i < count; ++i) {
        x[i] = 0;
        for (int j = 0; j < count; ++j) x[i] += reply_[i * count + j] * b[j];
    }
}

}  // namespace jvari
