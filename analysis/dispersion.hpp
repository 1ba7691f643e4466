// Frequency and decay rate of partials from a trace, far below the width of an FFT bin.
//
// A band of the signal x = sum a_k exp((2 pi i f_k - sigma_k) t) is shifted to 0 Hz, weighted by a Kaiser window and thinned out. Damped
// exponentials pass any such filter unchanged but for their amplitude, so what is left is again a sum of few damped exponentials,
// and the matrix pencil with a truncated singular value decomposition gives their poles (Hua & Sarkar 1990; Van Huffel et al. 1994, HTLS).
// Exact but for rounding, noise, and partials outside the band (150 dB down at twice its half width).
// Leaves out partials that change while they sound: a string against an obstacle has no modes of its own; use it on free strings.
#pragma once

#include <span>
#include <vector>

namespace jvari {

struct Partial {
    double frequency;  // f [Hz]
    double decay;      // sigma [1/s]; negative: it grows
    double amplitude;  // at the first row, in the unit of the signal: a real partial is amplitude exp(-sigma t) cos(2 pi f t + phase)
    double phase;      // [rad], at the first row
};

// The partials with from < f < to [Hz] that stand out of the noise and are no more than 140 dB below the signal's largest value, by
// ascending frequency; none where the record is too short for the band (it needs about 6.5/(to - from) seconds for the filter alone),
// is not finite, or is zero.
// The band wants to be as wide as twice the decay rate in Hz (sigma/pi) or more, and to hold fewer than about 40 partials.
std::vector<Partial> partials_between(std::span<const double> signal, double rate, double from, double to);

// The partial with the most energy within `half_width` [Hz] of `guess`; all NaN where there is none. A good half width is 0.4 of the
// distance to the next partial.
Partial partial_near(std::span<const double> signal, double rate, double guess, double half_width);

double cents(double frequency, double reference);  // 1200 log2(frequency/reference)

}  // namespace jvari
