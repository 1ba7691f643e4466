// Are two sounds statistically the same, although their waveforms differ? Each is an ensemble of runs from starts that differ too little
// to be known. The ensembles are compared in traits: level and decay of each third octave, spectral centroid of each quarter of the run.
//
// Each trait is tested by Kolmogorov and Smirnov's two-sample test with Stephens' correction for short samples (Stephens 1970, J. R. Stat.
// Soc. B 32, 115). The false-discovery rate of Benjamini & Hochberg (1995, J. R. Stat. Soc. B 57, 289) covers all traits together: for two
// ensembles of one distribution at most a share of `false_alarms` of the comparisons finds a difference. Bands more than 100 dB below the
// strongest are left out, and so are differences of medians below `Trait::least`. Dependence between traits is not modelled.
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
    double least;      // the smallest difference of medians that counts, in the same unit
};
std::vector<Trait> traits_of(std::span<const double> signal, double rate);

// The probability that two samples of one distribution differ as much as these.
double two_sample_p(std::vector<double> a, std::vector<double> b);

// Which of these probabilities are discoveries at this false-discovery rate.
std::vector<bool> discoveries(const std::vector<double>& p, double rate);

struct Told {
    Trait reference;   // its value is the reference's median
    double candidate;  // median
    double p;          // of two_sample_p
    bool apart;
};
// Each run, all of one scene, has one row of traits. A trait that is missing (NaN) in a run is left out for that run.
std::vector<Told> told_apart(const std::vector<std::vector<Trait>>& candidates, const std::vector<std::vector<Trait>>& references);

}  // namespace jvari
