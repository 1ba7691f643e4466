// What every error is measured against: the motion of the scene, and not of the model that a
// comparison happens to carry.
//
// A string cut off at 133 modes is another string: its nut force after half a second has little to
// do with that of the scene. So the reference does not take its modes from the cells, nor their
// compliance: unless one was asked for it is matched where the reference can carry that, which is
// nearer with the same modes. From those of modes_to_begin_with, and from the points that stand for
// a profile unasked, both are doubled until what is still left out moves the headline figure by
// less than `settled`, or until the next doubling is not within_budget. Where that was too hopeful
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
#include "bench/study/reference_size.hpp"

namespace jvari::bench::study {

// a tenth of the finest accuracy that the table of the cheapest asks for
constexpr double settled = 1e-4;

// The reference with the modes of the scene. `modes` 0: found by doubling, from `begin`. Else N:
// with N/4 and N/2 before it, to tell what N leaves out; points of a profile likewise, where they
// are asked for or N is. A stand-in is left as it is. `description`: how far it went. Throws as
// run_reference; PastItsLimit also where the first size would take more than ten minutes. `effort`:
// what all limits are multiplied by that nobody asked for. `settles_whole`: what doubling has to
// settle is the whole run, not the headline's window.
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
                const store::Listener&, double time_limit = HUGE_VAL, int begin = 0,
                double effort = 1, bool settles_whole = false);

// What the reference leaves out, by a measure of how far one trace lies from another: what its
// doublings tell, and where it is matched own modes as well. NaN: unknown. `solved_to`: how far
// each of its runs is solved.
using Apart = std::function<double(const Trace&, const Trace& from)>;
double left_out(const Truth&, const Apart&, double solved_to = 0);

// ---- For truth_search.cpp

constexpr std::array trust_windows = {10e-3, 50e-3, HUGE_VAL};  // [s], those of Trust

// relative L2 over a window from the instant `from` on [s]
double change(const Trace& more, const Trace& fewer, int tap, double from, double window);
// Of a truth that was doubled to this size: `solved` is what its certificate says.
Trust trust_of(const Trust& solved, const Truth&, const Size&, double from);
// With as many own modes as the matched one has, and with half as many, each extrapolated.
std::vector<Trace> own_motion(const ReferenceChoice& matched, const Scene&, const Size&, int jobs,
                              const store::Listener&, double time_limit);

// ----

// Of those that were run the one with the cell's modes and compliance, or nullptr. `model`: with
// the modes that cells take unasked (0: each its own); where it is matched it serves cells of
// either compliance.
const Reference* of_modes(const Cell&, const Reference& model, const Truth&);

}  // namespace jvari::bench::study
