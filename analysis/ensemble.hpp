// Is a sound statistically another's, where its waveform is not? Two ensembles of runs, each from starts that differ by less than anyone
// can know, are compared trait by trait: third-octave level and decay of each band, spectral centroid of each quarter of the run.
//
// Each trait by the two-sample test of Kolmogorov and Smirnov with Stephens' correction for short samples (Stephens 1970, J. R. Stat.
// Soc. B 32, 115), all of them together by the false-discovery rate of Benjamini & Hochberg (1995, J. R. Stat. Soc. B 57, 289): where the
// two ensembles are of one distribution, something is told apart in at most `false_alarms` of all comparisons. Leaves out: bands that are
// no more than 100 dB below the strongest, medians that are closer than what is worth telling (`Trait::least`), and how traits depend
// on each other.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace jvari {

constexpr double false_alarms = 0.05;

struct Trait {
    std::string kind;  // "third_octave_db", "decay_db_per_s", "centroid_hz"
    double where;      // centre of the band [Hz], or middle of the quarter [s]
    double value;      // [dB], [dB/s], [Hz]
    double least;      // a difference of medians that is worth telling, in the same unit
};
std::vector<Trait> traits_of(std::span<const double> signal, double rate);

// The probability that two samples of one distribution are as far apart as these.
double two_sample_p(std::vector<double> a, std::vector<double> b);

// Which of these probabilities are discoveries at this rate of false ones.
std::vector<bool> discoveries(const std::vector<double>& p, double rate);

struct Told {
    Trait reference;   // its value: the reference's median
    double candidate;  // median
    double p;          // of two_sample_p
    bool apart;
};
// One row of traits for each run, all of one scene. Traits that are missing (NaN) in a run are left out there.
std::vector<Told> told_apart(const std::vector<std::vector<Trait>>& candidates, const std::vector<std::vector<Trait>>& references);

}  // namespace jvari
