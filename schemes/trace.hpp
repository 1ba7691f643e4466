// Trace: what a run produced. Column-major; row n is at t = n/tap_rate, row 0 the initial state.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace jvari {

struct Trace {
    double tap_rate = 0;             // [Hz]
    long rows = 0;                   // rows that are valid
    long stride = 0;                 // rows allocated per column
    std::vector<std::string> names;  // one per tap
    std::vector<double> tap;         // stride x taps
    std::vector<double> energy;      // stride x 3 (stored, supplied, dissipated [J]) or empty

    int taps() const { return static_cast<int>(names.size()); }
    std::span<const double> column(int k) const { return {tap.data() + k * stride, static_cast<std::size_t>(rows)}; }
    std::span<const double> energy_column(int k) const { return {energy.data() + k * stride, static_cast<std::size_t>(rows)}; }
};

}  // namespace jvari
