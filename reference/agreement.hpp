// Measures how closely two traces of the same scene agree: relative L2 over windows, and the time
// until which they agree within a given tolerance. The sums come from schemes/trace.hpp, like those
// in error measurements.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari {

// Window lengths [s] from the end of the last excitation on (free_from); the last window reaches to
// the end. The list includes the comparison's own windows.
constexpr std::array<double, 7> agreement_windows = {10e-3,  20e-3,  50e-3, 100e-3,
                                                     200e-3, 500e-3, 1e300};
constexpr std::array<double, 3> agreement_levels = {1e-3, 1e-6, 1e-9};

// Rows from that instant on.
std::span<const double> rows_from(std::span<const double>, double seconds, double rate);

// Compares all rows of both with t < until; a window beyond the end covers all rows.
double relative_difference(std::span<const double> a, std::span<const double> b, double rate,
                           double until);

struct Agreement {                                               // for one tap
    std::array<double, agreement_windows.size()> relative_l2{};  // by agreement_windows
    std::array<double, agreement_levels.size()> until{};         // by agreement_levels [s]
};
Agreement agreement(std::span<const double> a, std::span<const double> b, double rate);

// Estimates the total change by all further doublings from the changes so far, the first one first;
// none: NaN. The further changes form a geometric series with the ratio of the last two. After a
// single doubling the estimate is the certificate's (and_further_ones). If the last two fall more
// slowly than at order one half, that order and the larger change are used. If the last change is
// the largest, nothing is known about a limit: NaN.
//
// Convergence is uneven, and one pair can agree by chance. However fast it seems, the estimate is
// therefore no less than at order one, or at order one half for matched modes. Of own modes it is
// also no less than order one leaves after the change before, less the last change. Examples,
// after doublings that changed a tap by e. With own modes the remaining change was 0.6 e in the
// bridge force of C3 with contact loss, and 2 e in the nut force of a hammer's blow, where the
// change before was 4 e. With matched modes it was 1.1 e in the bridge force of C3 without loss,
// and 1.4 e in the displacement with a thread of 1e3 N/m.
double left_after(std::span<const double> changes, bool matched);

// Matched solutions are doubled from matched ones, which agree with one another even if matching is
// wrong. Own modes err by 1/modes, so 2 y(N) - y(N/2) errs by 1/N^2. The error of a matched
// solution is no less than its distance `apart` from that extrapolation. An exception is a distance
// below the `change` in the extrapolation itself since half the number of modes.
double no_less(double left_out, double apart, double change);
std::vector<double> extrapolated(std::span<const double> own, std::span<const double> of_half);

// Ratio between the total change by all doublings of modes or points and the first change, at order
// one half: 1/(1 - 2^-1/2), rounded up. Displacements have an order above one. The force of a stiff
// contact converges slowly: C3's at 60 modes needs 3.2.
constexpr double and_further_ones = 3.5;
// Matched modes change little at first, and then unevenly: a corner that is pressed on a stiff
// barrier in the open string needs 7.1.
constexpr double matched_and_further_ones = 8;

// Noise floor: two programs cannot agree better than one program with itself when the starting
// points differ by this much.
constexpr double floor_displacement = 1e-12;
Scene moved(Scene, double factor);  // with every start and every pluck scaled

}  // namespace jvari
