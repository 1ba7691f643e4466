// How far two traces of the same scene agree: relative L2 over the windows that every figure of this program uses, and the time until which
// they agree to a given closeness.
#pragma once

#include <array>
#include <span>

#include "schemes/trace.hpp"

namespace jvari {

constexpr std::array<double, 3> agreement_windows = {10e-3, 50e-3, 1e300};  // 0 to this, or to the end [s]
constexpr std::array<double, 3> agreement_levels = {1e-3, 1e-6, 1e-9};

// Over rows 0 ... min(rows of both, t <= until): ||a - b||/||b||; 0 where both are zero throughout.
double relative_difference(std::span<const double> a, std::span<const double> b, double rate, double until);

// The first instant at which ||a - b||_[0,t] passes level x max(||b||_[0,t], max |b|); the last common instant where it never does [s].
double agree_until(std::span<const double> a, std::span<const double> b, double rate, double level);

struct Agreement {                        // of one tap
    std::array<double, 3> relative_l2{};  // by agreement_windows
    std::array<double, 3> until{};        // by agreement_levels [s]
};
Agreement agreement(std::span<const double> a, std::span<const double> b, double rate);

}  // namespace jvari
