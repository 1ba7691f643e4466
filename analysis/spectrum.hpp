// Spectra of a trace: levels in bands, spectrograms, and the differences of them that forgive what an ear forgives (phase, small delays).
//
// Signals have one row per 1/rate [s]; powers are one-sided mean squares in the unit of the signal squared, so that a sine of amplitude A
// holds A^2/2 whatever the window. The window is the periodic Hann, w[n] = (1 - cos(2 pi n/N))/2, unless said otherwise.
// Where two signals are compared the candidate is cut to the reference's rows; one that is shorter or not finite differs by +inf,
// and a reference that is not finite, empty or zero all over gives NaN. Leaves out any model of hearing.
#pragma once

#include <span>
#include <vector>

namespace jvari {

enum class Taper { hann, rectangular };

struct PowerSpectrum {
    double bin_hz = 0;          // width of a bin [Hz]; bin k is at k bin_hz
    std::vector<double> power;  // rows/2 + 1; sum = sum (x w)^2/sum w^2
};
PowerSpectrum power_spectrum(std::span<const double> signal, double rate, Taper = Taper::hann);  // any length; empty for no rows

struct Spectrogram {
    int frames = 0, bins = 0;
    double bin_hz = 0;          // [Hz]
    double hop = 0;             // from a frame to the next [s]
    double centre = 0;          // instant of the middle of frame 0 [s]
    std::vector<double> power;  // frames x bins, row-major
    std::span<const double> frame(int m) const { return std::span(power).subspan(static_cast<std::size_t>(m) * bins, bins); }
};
// Whole frames of `window` rows every `hop` rows; a signal shorter than one window is one frame, its rest filled with zeros.
// Throws std::invalid_argument unless window >= 2 and hop >= 1.
Spectrogram spectrogram(std::span<const double> signal, double rate, int window, int hop);

// ---- Bands.

struct Bands {
    std::vector<double> centre;  // exact centre frequencies, 1000 x 10^(n/10) [Hz]
    std::vector<double> level;   // 10 log10 of the mean square in the band [dB re the unit squared]; -inf for none
};
// What a comparison of bands looks at: all third octaves that are whole below half of 44.1 kHz, and the lowest ones that a second resolves.
struct BandChoice {
    double lowest = 50, highest = 16e3;  // centres from here to here, with 2 % to spare for their nominal names [Hz]
    Taper taper = Taper::hann;
    double range = 100;  // energy: within so much of the reference's strongest band [dB]
};

// Third octaves, base ten (IEC 61260-1, ISO 266), edges at 10^(+-1/20) of the centre, ideal flanks: the power of the bins between the
// edges, a bin that straddles an edge shared by its width. Left out: bands narrower than a bin, and those whose centre is at half the rate
// or above; the last is cut there.
Bands third_octaves(std::span<const double> signal, double rate, const BandChoice& = {});

// Root mean square over bands of candidate level - reference level [dB]. The bands are those where the reference has energy; below the
// floor of that range the candidate's level is set to the floor. The choice matters. The Hann taper resolves weak bands beside strong
// ones, and with it a band between two partials, or below the first, weighs as much as one that sounds. The rectangular one weighs the
// attack like the rest, and the jump from the last row to the first leaks into bands far below their neighbours.
// Bridge force of the released C3 string over 1 s, two-point scheme at 44.1 kHz x1, x4, x16, x64 against the exact reference:
// 7.4, 2.9, 1.2, 0.6 dB as chosen here; 5.5, 2.4, 0.5, 0.2 dB rectangular from 100 Hz to 20 kHz.
double third_octave_difference(std::span<const double> candidate, std::span<const double> reference, double rate, const BandChoice& = {});

// ---- Time and frequency.

struct StftDifference {
    double level;        // mean |20 log10(|C|/|R|)| [dB]
    double convergence;  // || |C| - |R| ||_F / || |R| ||_F ("spectral convergence")
};
// Of one resolution, frames every window/4 rows. `level` runs over the cells where the reference is within `range` [dB] of its
// strongest; the candidate is not taken below that floor.  (Arik, Jun & Diamos 2019; Yamamoto, Song & Kim 2020, eqs 4-6, where the
// logarithm is natural: 8.686 dB)
StftDifference stft_difference(std::span<const double> candidate, std::span<const double> reference, double rate, int window,
                               double range = 100);
// The mean over windows of 512, 1024, 2048 and 4096 rows; windows longer than the signal are left out unless none is left.
StftDifference multi_resolution_stft_difference(std::span<const double> candidate, std::span<const double> reference, double rate);

// Spectral centroid of each frame [Hz]: sum f P/sum P over the bins' powers; NaN where a frame holds none.
std::vector<double> centroid_track(const Spectrogram&);

// Root mean square difference of two centroid tracks [Hz], frames of 2048 rows every 512, over those within 60 dB of the reference's
// strongest.
double centroid_difference(std::span<const double> candidate, std::span<const double> reference, double rate);

// Upper envelope [dB]: at each bin the largest level within half of `width_hz` on either side. A width above the spacing of the
// partials joins their peaks.
std::vector<double> spectral_envelope(const PowerSpectrum&, double width_hz);

}  // namespace jvari
