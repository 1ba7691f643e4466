// States in series with a string's points (in_series.hpp), for string_equations.hpp: the states w
// z, w^2 = S_jj/m, are velocities like the modes'. A point's displacement is then the modes'
// displacement plus one state, whose velocity its own force moves at once.
#pragma once

#include <cmath>
#include <vector>

#include "reference/in_series.hpp"

namespace jvari {

struct SeriesStates {
    int count = 0, points = 0;

    SeriesStates() = default;
    SeriesStates(const InSeries& series, double mass)
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

    // the states in their own units
    void read(const double* w, double* z) const noexcept {
        for (int j = 0; j < count; ++j) z[j] = w[j] / width_[j];
    }
    void put(const double* z, double* w) const noexcept {
        for (int j = 0; j < count; ++j) w[j] = z[j] * width_[j];
    }
    // D_a [m]
    double yield(int a, const double* w) const noexcept { return count > 0 ? w[a] / width_[a] : 0; }
    // D_a' without forces
    double yield_speed(int a, const double* w) const noexcept {
        return count > 0 ? moved(a, w) / width_[a] : 0;
    }
    // D_a' by F_a [m/(N s)]
    double at_once(int a) const noexcept {
        return count > 0 ? push_[a * points + a] / width_[a] : 0;
    }
    double push(int i, int a) const noexcept { return push_[i * points + a]; }
    double share(int a) const noexcept { return 1 / width_[a]; }  // weight of state a in D_a
    void speed(const double* w, const double* force, double* out) const noexcept {
        for (int i = 0; i < count; ++i) {
            out[i] = moved(i, w);
            for (int a = 0; a < points; ++a) out[i] += push(i, a) * force[a];
        }
    }
    // speed' Q other [W]
    double lost(const double* speed, const double* other) const noexcept {
        double sum = 0;
        for (int i = 0; i < count; ++i)
            for (int j = 0; j < count; ++j) sum += speed[i] * losing_[i * count + j] * other[j];
        return sum;
    }

    // (I - gamma A) x = b + gamma B dF
    void factor(double gamma) noexcept {
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
    // with dF = 0
    void solve(const double* b, double* x) const noexcept {
        for (int i = 0; i < count; ++i) {
            x[i] = 0;
            for (int j = 0; j < count; ++j) x[i] += reply_[i * count + j] * b[j];
        }
    }
    // x_i/(gamma dF_c)
    double answer(int i, int c) const noexcept { return reply_[(count + c) * count + i]; }
    double answer_speed(int a, int c) const noexcept {
        return moved(a, reply_.data() + (count + c) * count) / width_[a];
    }

private:
    double moved(int i, const double* w) const noexcept {
        double sum = 0;
        for (int j = 0; j < count; ++j) sum += drift_[i * count + j] * w[j];
        return sum;
    }
    std::vector<double> width_;  // w [1/s]
    // A [state][state], B [state][point] and Q [state][state], for w z
    std::vector<double> drift_, push_, losing_;
    // (I - gamma A)^-1 [state][state], and times B behind it [point][state]
    std::vector<double> reply_, left_;
};

}  // namespace jvari
