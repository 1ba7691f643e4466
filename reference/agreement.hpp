// How far two traces of the same scene agree: relative L2 over windows, and the time until which
// they agree to a given closeness. The sums are those of schemes/trace.hpp, which errors are
// measured with as well.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari {

// So long [s] from the end of the last excitation on (free_from); the last one is to the end. The
// comparison's own windows are among them.
constexpr std::array<double, 7> agreement_windows = {10e-3,  20e-3,  50e-3, 100e-3,
                                                     200e-3, 500e-3, 1e300};
constexpr std::array<double, 3> agreement_levels = {1e-3, 1e-6, 1e-9};

// from that instant on
std::span<const double> rows_from(std::span<const double>, double seconds, double rate);

// Over the rows of both with t < until; a window longer than they are is the whole of them.
double relative_difference(std::span<const double> a, std::span<const double> b, double rate,
                           double until);

struct Agreement {                                               // of one tap
    std::array<double, agreement_windows.size()> relative_l2{};  // by agreement_windows
    std::array<double, agreement_levels.size()> until{};         // by agreement_levels [s]
};
Agreement agreement(std::span<const double> a, std::span<const double> b, double rate);

// What all further doublings change, by what each changed so far, the first one first; none: NaN.
// They are a geometric series whose ratio is that of the last two. With one doubling it is what a
// certificate says of one (and_further_ones). Where the last two do not get smaller so fast as of
// order one half, that order and the larger of them count. Where the last one is the largest of all
// nothing is known of a limit: NaN. They converge unevenly, and one pair can agree by chance:
// however fast they seem to, what order one leaves is left at least, of matched modes what order
// one half leaves. Seen after doublings that changed a tap by e: with own modes 0.6 e in the bridge
// force of C3 that loses at contact; matched 1.1 e in that without loss, 1.4 e in the displacement
// with a thread of 1e3 N/m.
double left_after(std::span<const double> changes, bool matched);

// Matched solutions are doubled from matched ones, which agree with one another also where matching
// is wrong. Own modes err as 1/modes, so 2 y(N) - y(N/2) errs as 1/N^2. What a matched solution
// leaves out is no less than it lies `apart` from that, unless that is no more than the `change` of
// the extrapolation itself since half as many modes.
double no_less(double left_out, double apart, double change);
std::vector<double> extrapolated(std::span<const double> own, std::span<const double> of_half);

// What all doublings of modes or points together change, over what the first does, for an order of
// one half: 1/(1 - 2^-1/2), rounded up. Displacements have an order above one. But the force of a
// stiff contact is slow: C3's at 60 modes needs 3.2.
constexpr double and_further_ones = 3.5;
// Matched modes change little at first, and then unevenly: a corner that is pressed on a stiff
// barrier in the open string needs 7.1.
constexpr double matched_and_further_ones = 8;

// No two programs can agree better than one with itself, started so much apart: the noise floor.
constexpr double floor_displacement = 1e-12;
Scene moved(Scene, double factor);  // with every start and every pluck scaled

}  // namespace jvari
