// Compares a signal with a late copy, or with a copy on another clock and with another decay, and
// says how much of the difference this explains.
//
// Both signals have one row per 1/rate. Between rows they are band-limited: a sinc under a Hann
// window of 32 rows, good to 0.45 of the rate. Rows without this neighbourhood are left out.
#pragma once

#include <cstddef>
#include <span>

namespace jvari {

struct Alignment {
    double late = 0;     // the run behind the reference [rows]
    double stretch = 0;  // ratio between the run's frequencies and the reference's, minus 1
    double decay = 0;    // decay of the run minus decay of the reference [1/row]
    // norm of the remaining difference, over the norm of the whole difference; 1: nothing is
    // explained
    double left = 1;
};

// Model: run[n] = reference[n - late], within `furthest` rows and an eighth of the signal. If two
// delays fit equally well, for example for a periodic signal, the smaller one is returned.
Alignment delayed(std::span<const double> run, std::span<const double> reference, long furthest);

// run[n] = exp(-decay n) reference[n (1 + stretch)], judged from row `first` on, with a stretch of
// an eighth at most. Found over 64 rows, then over twice as many, so that no period is skipped.
Alignment stretched(std::span<const double> run, std::span<const double> reference,
                    std::size_t first);

// What is left where the stretch, or the decay, of that alignment is undone alone.
double left_by(std::span<const double> run, std::span<const double> reference, std::size_t first,
               double stretch, double decay);

}  // namespace jvari
