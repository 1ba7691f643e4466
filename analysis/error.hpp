// Waveform errors: how far a candidate is from a reference, and until when it follows it.
//
// Both signals have the same unit and one row per 1/rate; row n is at t = n/rate. The error is
//   +inf if the candidate has a NaN or an infinity, or stops before the window ends,
//   NaN if the reference does not cover the window, or the window has no row,
//   0 if both are zero in the whole window, and NaN if only the reference is.
// Signals are not aligned in time or level: a delayed or scaled copy counts as an error.
// spectrum.hpp has measures that ignore the delay.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "schemes/trace.hpp"

namespace jvari {

struct Window {       // the rows with from <= t < to
    double from = 0;  // [s]
    // [s]; infinity: to the end of the reference
    double to = std::numeric_limits<double>::infinity();
};

// ||candidate - reference|| / ||reference|| over the rows of the window; dimensionless.
double relative_l2(std::span<const double> candidate, std::span<const double> reference,
                   double rate, Window = {});

// Predictability horizon [s]: the first instant t at which the running error
//     E(t) = ||candidate - reference||_[0,t] / max(||reference||_[0,t], max|reference|)
// passes `threshold`, or the reference's duration if this never happens. The second part of the
// maximum is a single row with the largest value. For a string that starts from rest it keeps the
// first rows, in which the running norm is nearly zero, from deciding. A candidate that stops early
// or is not finite counts until its last finite row.
double horizon(std::span<const double> candidate, std::span<const double> reference, double rate,
               double threshold = 0.1);

// One error for each tap. Throws std::invalid_argument unless the traces have the same taps at the
// same rate.
std::vector<double> relative_l2(const Trace& candidate, const Trace& reference, Window = {});

}  // namespace jvari
