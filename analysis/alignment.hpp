// Compares a signal with a late copy, or with a copy on another clock and with another decay, and
// says how much this explains of the difference.
//
// Both signals have one row per 1/rate. Between rows they are band-limited: a sinc under a Hann
// window of 32 rows, good to 0.45 times the rate. Rows without this neighbourhood are left out.
#pragma once

#include <cstddef>
#include <span>

namespace jvari {

struct Alignment {
    double late = 0;     // the run behind the reference [rows]
    double stretch = 0;  // ratio between the run's frequencies and the reference's, minus 1
    double decay = 0;    // the run's decay minus the reference's [1/row]
    // norm of the remaining difference, over the norm of the whole; 1: nothing is explained
    double left = 1;
};

// Model: run[n] = reference[n - late], within `furthest` rows and an eighth of the signal. If two
// delays fit equally well, for example in a periodic signal, the smaller one is returned.
Alignment delayed(std::span<const double> run, std::span<const double> reference, long furthest);

// Model: run[n] = exp(-decay n) reference[n (1 + stretch)], judged from row `first` on, with a
// stretch up to an eighth. The search covers 64 rows, then twice as many each time, so that no
// period is skipped.
Alignment stretched(std::span<const double> run, std::span<const double> reference,
                    std::size_t first);

// Remaining difference if only the stretch, or only the decay, of that alignment is undone.
double left_by(std::span<const double> run, std::span<const double> reference, std::size_t first,
               double stretch, double decay);

}  // namespace jvari
