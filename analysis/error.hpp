// Waveform errors: how far a candidate is from a reference, and for how long it can be trusted.
//
// Both signals have one row per 1/rate and the same unit; row n is at t = n/rate. What is never hidden:
//   a candidate that holds a NaN or an infinity, or that stops before the window ends, has the error +inf;
//   a window that the reference does not cover (or that holds no row at all) has the error NaN: nothing to compare with;
//   a reference that is zero all over the window gives 0 where the candidate is zero as well, else NaN.
// Leaves out alignment in time and level: a delayed or scaled copy is an error here (spectrum.hpp forgives the delay).
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "schemes/trace.hpp"

namespace jvari {

struct Window {                                           // the rows with from <= t < to
    double from = 0;                                      // [s]
    double to = std::numeric_limits<double>::infinity();  // [s]; infinity: to the end of the reference
};

// ||candidate - reference|| / ||reference|| over the rows of the window; dimensionless.
double relative_l2(std::span<const double> candidate, std::span<const double> reference, double rate, Window = {});

// Predictability horizon [s]: the first instant t at which the running error
//     E(t) = ||candidate - reference||_[0,t] / max(||reference||_[0,t], max|reference|)
// passes `threshold`; the duration of the reference (its last row) where it never does. [0,t] holds its last row. The second part of
// the maximum, one row as large as the largest, keeps the first rows of a string that starts from rest from deciding:
// there the running norm is still next to nothing. A candidate that stops early or is not finite is trusted until its last sound row.
double horizon(std::span<const double> candidate, std::span<const double> reference, double rate, double threshold = 0.1);

struct TapErrors {
    std::vector<double> tap;  // one per tap of the reference
    double worst;             // largest of them: +inf if any is, else NaN if any is
    double combined;          // their root mean square (each tap relative to its own norm, so units do not matter)
};
// Throw std::invalid_argument where the two traces do not have the same taps at the same tap rate.
TapErrors relative_l2(const Trace& candidate, const Trace& reference, Window = {});

struct TapHorizons {
    std::vector<double> tap;  // [s], one per tap of the reference
    double shortest;          // [s]; NaN for a trace without taps
};
TapHorizons horizon(const Trace& candidate, const Trace& reference, double threshold = 0.1);

}  // namespace jvari
