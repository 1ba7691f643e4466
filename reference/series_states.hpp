// What is in series with a string's points (in_series.hpp), for string_equations.hpp: its states w
// z, w^2 = S_jj/m, are velocities as the modes' are. A point's displacement then is that of the
// modes and one of them, whose velocity its own force moves at once.
#pragma once

#include <vector>

#include "reference/in_series.hpp"

namespace jvari {

struct SeriesStates {
    int count = 0, points = 0;

    SeriesStates() = default;
    SeriesStates(const InSeries&, double mass);

    void read(const double* w, double* z) const noexcept;  // the states in their own units
    void put(const double* z, double* w) const noexcept;
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
    double share(int a) const noexcept { return 1 / width_[a]; }  // of state a in D_a
    void speed(const double* w, const double* force, double* out) const noexcept;
    double lost(const double* speed, const double* other) const noexcept;  // speed' Q other [W]

    // (I - gamma A) x = b + gamma B dF
    void factor(double gamma) noexcept;
    // with dF = 0
    void solve(const double* b, double* x) const noexcept;
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
    // A [state][state], B [state][point] and Q [state][state], of w z
    std::vector<double> drift_, push_, losing_;
    // (I - gamma A)^-1 [state][state], and times B behind it [point][state]
    std::vector<double> reply_, left_;
};

}  // namespace jvari
