// Runs a scheme as its own reference: at a multiple of a rate, on the rows of that rate, with an
// error estimate by Richardson's rule.
//
// Three runs are made, at multiple/4, multiple/2 and multiple times the rate. Let d1, d2 be the
// differences between the first pair and between the second. The observed order is p =
// log2(|d1|/|d2|), and the finest run's error is about |d2|/(2^p - 1), multiplied here by
// `caution`. Near contact p scatters about 1 and is no asymptotic order. Therefore p is limited to
// the range from 1/4 to `trusted_order`, and the estimate leans to the cautious side. The result is
// an estimate: unlike the other references this one has no bound, and it cannot see errors that the
// scheme makes at every rate.
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
    double rate = 0;          // sample rate of the reference [Hz]
    double wall_seconds = 0;  // total for the three runs
    // estimated error, relative L2 [tap][window]
    std::vector<std::array<double, agreement_windows.size()>> estimates;
};

// settings.sample_rate is the candidate's; `multiple` is a multiple of 4 (Refusal otherwise).
// Throws the errors of the scheme's make. A run that fails ends the series: `run` is then that run,
// with its status, and `estimates` is empty.
Oversampled oversampled(const Descriptor&, const Scene&, const Settings&, int multiple,
                        const RunOptions& = {});

// Schemes that may stand in if no reference represents the scene: the highest-ranked schemes among
// those that represent the scene.
std::vector<const Descriptor*> stand_ins(const Scene&);

// Estimates a scheme's own error over the first `trial` of the scene, at the same rates and for the
// worst tap, by oversampled(). Infinite if the scheme refuses or fails.
constexpr double trial = 10e-3;  // [s]
double estimate_of(const Descriptor&, const Scene&, const Settings&, int multiple,
                   const RunOptions& = {});

// Returns the scheme with the least estimated error, the first among equals; nullptr for an empty
// list. A single scheme is not tried.
const Descriptor* best_by_estimate(const std::vector<const Descriptor*>&, const Scene&,
                                   const Settings&, int multiple, const RunOptions& = {});

}  // namespace jvari
