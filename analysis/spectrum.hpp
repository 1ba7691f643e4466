// Spectra of a trace: levels in bands, spectrograms, and differences between them that ignore
// inaudible differences (phase, small delays).
//
// Signals have one row per 1/rate [s]. Powers are one-sided mean squares in squared signal units: a
// sine with amplitude A has A^2/2 with any window. The default window is the periodic Hann, w[n] =
// (1 - cos(2 pi n/N))/2. To compare two signals, the candidate is cut to the reference's rows. The
// difference is +inf if the candidate is shorter or not finite, and NaN if the reference is not
// finite, empty or zero. There is no model of hearing.
#pragma once

#include <span>
#include <vector>

namespace jvari {

enum class Taper { hann, rectangular };

struct PowerSpectrum {
    double bin_hz = 0;          // width of a bin [Hz]; bin k is at k bin_hz
    std::vector<double> power;  // rows/2 + 1; sum = sum (x w)^2/sum w^2
};
// any length; empty without rows
PowerSpectrum power_spectrum(std::span<const double> signal, double rate, Taper = Taper::hann);

// Power between two frequencies [Hz]: each bin spreads its power evenly over its own width.
double power_between(const PowerSpectrum&, double from, double to);

struct Spectrogram {
    int frames = 0, bins = 0;
    double bin_hz = 0;          // [Hz]
    double hop = 0;             // time from one frame to the next [s]
    double centre = 0;          // middle of frame 0 [s]
    std::vector<double> power;  // frames x bins, row-major
    std::span<const double> frame(int m) const {
        return std::span(power).subspan(static_cast<std::size_t>(m) * bins, bins);
    }
};
// Frames of `window` rows every `hop` rows. A signal shorter than one window becomes one frame,
// filled up with zeros. Throws std::invalid_argument unless window >= 2 and hop >= 1.
Spectrogram spectrogram(std::span<const double> signal, double rate, int window, int hop);

// ---- Bands.

struct Bands {
    std::vector<double> centre;  // exact centre frequencies, 1000 x 10^(n/10) [Hz]
    // 10 log10 of the mean square in the band [dB re the unit squared]; -inf for none
    std::vector<double> level;
};
// Bands to be compared. Default: all third octaves below half of 44.1 kHz that one second of signal
// resolves.
struct BandChoice {
    // least and largest centre [Hz], with 2 % of tolerance for nominal names
    double lowest = 50, highest = 16e3;
    Taper taper = Taper::hann;
    double range = 100;  // bands within this distance from the reference's strongest count [dB]
};

// Third octaves of base ten (IEC 61260-1, ISO 266) with ideal flanks at 10^(+-1/20) of the centre.
// A bin across an edge is shared in proportion to its width. Bands narrower than a bin are left
// out, and bands whose centre is at half the rate or above; the last band ends at half the rate.
Bands third_octaves(std::span<const double> signal, double rate, const BandChoice& = {});

// Root mean square over bands of (candidate level - reference level) [dB], over the bands with
// reference energy. A candidate level below the floor of that range is set to the floor. The taper
// matters: Hann resolves weak bands beside strong ones, so that a band between two partials weighs
// the same for both. The rectangular taper weighs the attack like the rest, but the jump from the
// last row to the first leaks into bands far below their neighbours.
double third_octave_difference(std::span<const double> candidate, std::span<const double> reference,
                               double rate, const BandChoice& = {});

// ---- Time and frequency.

struct StftDifference {
    double level;        // mean |20 log10(|C|/|R|)| [dB]
    double convergence;  // || |C| - |R| ||_F / || |R| ||_F ("spectral convergence")
};
// One resolution, with frames every window/4 rows. `level` covers the cells in which the reference
// is within `range` [dB] of its strongest; the candidate's level does not go below that floor.
// (Arik, Jun & Diamos 2019; Yamamoto, Song & Kim 2020, eqs 4-6, with a natural logarithm: a factor
// of 8.686 dB)
StftDifference stft_difference(std::span<const double> candidate, std::span<const double> reference,
                               double rate, int window, double range = 100);
// Mean over windows of 512, 1024, 2048 and 4096 rows. Windows longer than the signal are left out,
// unless all are.
StftDifference multi_resolution_stft_difference(std::span<const double> candidate,
                                                std::span<const double> reference, double rate);

// Spectral centroid of each frame [Hz]: sum f P/sum P over the bins; NaN for a silent frame.
std::vector<double> centroid_track(const Spectrogram&);

// Two centroid tracks: the root mean square of their difference, and the mean of the reference's
// [Hz]. Frames more than 60 dB below the reference's strongest are left out.
struct CentroidDifference {
    double rms, mean;
    double relative() const { return rms / mean; }
};
CentroidDifference centroid_difference(std::span<const double> candidate,
                                       std::span<const double> reference, double rate, int window,
                                       int hop);

}  // namespace jvari
