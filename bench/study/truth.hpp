// What every error is measured against: the motion of the scene, and not of the model that a
// comparison happens to carry.
//
// A string cut off at 133 modes is another string: its nut force after half a second has little to
// do with that of the scene. So the reference does not take its modes from the cells, nor their
// compliance: unless one was asked for it is matched where the reference can carry that, which is
// nearer with the same modes. From those below 20 kHz, and from the points that stand for a profile
// unasked, both are doubled until what is still left out moves the headline figure by less than
// `settled`, or until the next doubling would cost more than `budget`. Where that was too hopeful
// and they have computed for a minute together, what was known before stands. compare and suite do
// this alike, and alike at every point of a sweep.
//
// What the reference leaves out follows from its own doublings, on every tap and window
// (left_after), and where it is matched from own modes beside it (no_less). Without a doubling and
// without a certificate its uncertainty is unknown. An error of less than ten times the uncertainty
// is shown as a bound (bound.hpp).
#pragma once

#include <functional>

#include "bench/study/cell.hpp"
#include "bench/study/reference.hpp"

namespace jvari::bench::study {

// a tenth of the finest accuracy that the table of the cheapest asks for
constexpr double settled = 1e-4;
// [s], of motion times modes^2 times 1 + 2.5 points (or barriers beyond the second) times how dear
// the reference is: ten to twenty seconds; of a short or stiff string more than modes^2 (truth.cpp)
constexpr double budget = 1.5e6;

// The reference with the modes of the scene. `modes` 0: found by doubling. Else N: with N/4 and N/2
// before it, to tell what N leaves out. A stand-in is left as it is. `description`: how far it
// went. Throws as run_reference.
struct Truth {
    Reference reference;
    bool matched = false;            // also where no option says so: over a rigid barrier
    std::vector<Reference> coarser;  // those that it was doubled from, the coarsest first
    // Where the reference is matched: the motion with as many own modes and with half as many,
    // each extrapolated. Empty where the scene has no own solution (a rigid barrier) or it took too
    // long.
    std::vector<Trace> own;
    std::string description;
    // [s], of the headline against itself with half the modes and points
    double horizon = std::numeric_limits<double>::quiet_NaN();
};
Truth run_truth(const std::vector<ReferenceChoice>&, const Scene&, int modes, int jobs,
                const store::Listener&, double time_limit = HUGE_VAL);

// What the reference leaves out, by a measure of how far one trace lies from another: what its
// doublings tell, and where it is matched own modes as well. NaN: unknown. `solved_to`: how far
// each of its runs is solved.
using Apart = std::function<double(const Trace&, const Trace& from)>;
double left_out(const Truth&, const Apart&, double solved_to = 0);

// Of those that were run the one with the cell's modes and compliance, or nullptr. `model`: with
// the modes that cells take unasked (0: each its own); where it is matched it serves cells of
// either compliance.
const Reference* of_modes(const Cell&, const Reference& model, const Truth&);

}  // namespace jvari::bench::study
