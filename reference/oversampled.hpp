// A scheme as its own reference: at a multiple of a rate, on the rows of that rate, with an
// estimate of its error by Richardson's rule.
//
// Three runs, at multiple/4, multiple/2 and multiple times the rate. With d1, d2 the differences of
// the first pair and of the second, the observed order is p = log2(|d1|/|d2|) and the finest run's
// error about |d2|/(2^p - 1), times `caution` here. Near contact p scatters about 1 and is no
// asymptotic order, so p counts as no more than `trusted_order` and no less than 1/4: the estimate
// leans to the cautious side. It is an estimate: unlike the other references this one has no bound,
// and it cannot see what the scheme gets wrong at every rate.
#pragma once

#include <array>
#include <vector>

#include "reference/agreement.hpp"
#include "schemes/run.hpp"

namespace jvari {

constexpr double trusted_order = 1;
constexpr double caution = 2;

struct Oversampled {
    Run run;                  // the finest
    double rate = 0;          // its sample rate [Hz]
    double wall_seconds = 0;  // of all three
    // of its error, relative L2 [tap][window]
    std::vector<std::array<double, agreement_windows.size()>> estimates;
};

// settings.sample_rate is the candidate's; `multiple` is a multiple of 4 (Refusal otherwise).
// Throws what the scheme's make throws. A run that fails ends the series: `run` is that run, with
// its status, and `estimates` is empty.
Oversampled oversampled(const Descriptor&, const Scene&, const Settings&, int multiple,
                        const RunOptions& = {});

// Those that may stand in where no reference represents the scene: of the schemes that do, those of
// the highest rank.
std::vector<const Descriptor*> stand_ins(const Scene&);

// What a scheme estimates its own error to be over the first `trial` of the scene, at the same
// rates as oversampled(): its worst tap. Infinite where it refuses or fails.
constexpr double trial = 10e-3;  // [s]
double estimate_of(const Descriptor&, const Scene&, const Settings&, int multiple,
                   const RunOptions& = {});

// Of these the one that estimates its own error least, the first among equals; nullptr of none. One
// alone is not tried.
const Descriptor* best_by_estimate(const std::vector<const Descriptor*>&, const Scene&,
                                   const Settings&, int multiple, const RunOptions& = {});

}  // namespace jvari
