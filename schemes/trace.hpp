// Trace: the output of a run. Column-major; row n is at t = n/tap_rate, row 0 the initial state.
// This file also compares two columns: its two sums certify references and measure errors.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace jvari {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();  // unknown value
inline constexpr double inf = std::numeric_limits<double>::infinity();

struct Trace {
    double tap_rate = 0;             // [Hz]
    long rows = 0;                   // valid rows
    long stride = 0;                 // rows allocated per column
    std::vector<std::string> names;  // one per tap
    // stride x taps, or as many columns again, read by modes below 20 kHz
    std::vector<double> tap;
    std::vector<double> energy;  // stride x 3 (stored, supplied, dissipated [J]) or empty

    int taps() const { return static_cast<int>(names.size()); }
    int columns() const { return stride > 0 ? static_cast<int>(tap.size() / stride) : 0; }
    std::span<const double> column(int k) const {
        return {tap.data() + k * stride, static_cast<std::size_t>(rows)};
    }
    // the tap's modes below 20 kHz; empty if the trace does not have them
    std::span<const double> heard(int k) const {
        return columns() == 2 * taps() ? column(taps() + k) : std::span<const double>();
    }
    std::span<const double> energy_column(int k) const {
        return {energy.data() + k * stride, static_cast<std::size_t>(rows)};
    }
};

// First row with t >= seconds. An instant within 1e-6 rows of a row counts exactly there: 0.05 s x
// 44100 Hz is row 2205 whatever the rounding.
long row_at(double seconds, double rate);

// ||a - b||/||b|| over the common rows; 0 if both are zero, +inf if b alone is. Sums are taken
// relative to the largest value of b, so that nothing under- or overflows.
double relative_difference(std::span<const double> a, std::span<const double> b);

// First instant t [s] at which ||a - b||_[0,t] exceeds level x max(||b||_[0,t], max |b|), [0,t]
// with its last row; the last row in b if this never happens. An a that stops early or is not
// finite agrees until its last sound row.
double agree_until(std::span<const double> a, std::span<const double> b, double rate, double level);

}  // namespace jvari
