// How far two traces of the same scene agree: relative L2 over windows, and the time until which
// they agree to a given closeness. The sums are those of schemes/trace.hpp, which errors are
// measured with as well.
#pragma once

#include <array>
#include <span>

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

// What all further doublings change, by what the last one changed and the one before it (NaN: there
// was none). They are a geometric series whose ratio is the one observed: at least a quarter, as of
// order two, since one pair can agree by chance. With one doubling, or where they do not get
// smaller so fast, the order is one half, and the larger of the two counts. Matched modes converge
// unevenly, so at least 1.2 times the last change is left: after a doubling that changed C3's
// bridge force by e, 1.08 e was left.
double left_after(double last, double before, bool matched);

}  // namespace jvari
