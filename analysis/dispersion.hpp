// Estimates frequency and decay rate of partials from a trace, far more finely than the width of an
// FFT bin.
//
// A band of the signal x = sum a_k exp((2 pi i f_k - sigma_k) t) is filtered by a Kaiser window,
// decimated, and shifted to a quarter of the new rate. The filter changes only the amplitudes of
// damped exponentials, so the result is again a sum of a few of them. The matrix pencil with a
// truncated singular value decomposition gives their poles (Hua & Sarkar 1990; Van Huffel et al.
// 1994, HTLS). The estimate is exact up to rounding, noise, and partials outside the band (150 dB
// down at twice its half width). Use it on free strings: a string against an obstacle has no
// partials that stay constant.
#pragma once

#include <span>
#include <vector>

namespace jvari {

struct Partial {
    double frequency;  // f [Hz]
    double decay;      // sigma [1/s]; negative if the partial grows
    // at the first row, in the unit of the signal: a real partial is amplitude exp(-sigma t) cos(2
    // pi f t + phase)
    double amplitude;
    double phase;  // [rad], at the first row
};

// Partials with from < f < to [Hz] that stand out of the noise and are at most 140 dB below the
// signal's largest value, by ascending frequency. The list is empty if the signal is too short for
// the band, not finite, or zero, or if the band is wider than rate/5. (The filter alone needs about
// 6.5/(to - from) seconds.) Choose a band at least twice the decay rate in Hz (sigma/pi), with
// fewer than about 40 partials.
std::vector<Partial> partials_between(std::span<const double> signal, double rate, double from,
                                      double to);

// Partial within `half_width` [Hz] of `guess` that is strongest at the first row: by energy over
// the record a growing spurious pole could be mistaken for it. NaN if there is none. A good half
// width is 0.4 times the distance to the next partial.
Partial strongest_near(std::span<const double> signal, double rate, double guess,
                       double half_width);

double cents(double frequency, double reference);  // 1200 log2(frequency/reference)

}  // namespace jvari
