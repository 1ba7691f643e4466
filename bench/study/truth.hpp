// Truth: the reference solution for every error. The truth is the motion of the scene, not of the
// model that a comparison happens to carry.
//
// A string cut off at 133 modes is another string: after half a second its nut force has little to
// do with the scene's. So the reference takes neither its modes nor its compliance from the cells.
// Unless the user asks for a compliance, it is matched if the reference supports matched, which is
// nearer to the scene with the same modes.
//
// The search begins with modes_to_begin_with, for a profile with a quarter of them and of the
// default points. One of the two is doubled at a time: the one that seems to leave out more. The
// doublings end when the part still left out moves the headline figure by less than `settled`, or
// when no further one is within_budget. If they have together computed for a minute, the result so
// far stands. compare and suite follow the same rules, at every point of a sweep.
//
// The effect of everything left out is estimated from the doublings, on every tap and window
// (left_after): the sum of what the modes leave out and of what the points do. Modes matter more
// where there are more points, so the last doubling of each ends at the truth. For a matched
// reference, runs with own modes give a second estimate (no_less).
// Without a doubling and without a certificate the uncertainty is unknown. An error below ten times
// the uncertainty is shown as a bound (bound.hpp).
#pragma once

#include <functional>

#include "bench/study/cell.hpp"
#include "bench/study/reference.hpp"
#include "bench/study/reference_size.hpp"

namespace jvari::bench::study {

// a tenth of the finest accuracy in the table of the cheapest
constexpr double settled = 1e-4;

// Reference with the modes of the scene. `modes` 0: found by doubling, from `begin`. `modes` N: N/4
// and N/2 run before N, to estimate the effect of the modes left out. Points of a profile follow
// the same rule if the user asks for points or modes (Sizes). A stand-in is left unchanged.
// `description`: how far the doubling went. `effort`: factor on all limits that nobody asked for.
// `settles_whole`: the doubling has to settle the whole run, not only the headline's window. Throws
// like run_reference; PastItsLimit also if the first size would take more than ten minutes.
struct Truth {
    Reference reference;
    bool matched = false;  // also true without the option: over a rigid barrier
    // Smaller runs, coarsest first. For a profile, the last has only half the modes or half the
    // points, so that a doubling of each ends at the reference.
    std::vector<Reference> coarser;
    bool has_points = false;  // a profile's points stand for it, and their number is doubled too
    bool all_modes = false;   // the string's table has no more modes
    // Motion with as many own modes and with half as many, each extrapolated, if the reference is
    // matched. Empty if the scene has no own solution (a rigid barrier) or if the runs took too
    // long.
    std::vector<Trace> own;
    std::string description;
    // frequency [Hz] above which it has no modes, as the string's table has none; NaN: no table
    double limit_hz = std::numeric_limits<double>::quiet_NaN();
    // horizon of the headline [s], compared with half the modes, or with half the points if that is
    // earlier
    double horizon = std::numeric_limits<double>::quiet_NaN();
};
Truth run_truth(const std::vector<ReferenceChoice>&, const Scene&, int modes, int jobs,
                const store::Listener&, double time_limit = HUGE_VAL, int begin = 0,
                double effort = 1, bool settles_whole = false);

// Estimates the effect of everything that the reference leaves out, by a distance between traces.
// The estimate uses the doublings and, for a matched reference, own modes. NaN: unknown.
// `solved_to`: accuracy of the solution of each run.
using Apart = std::function<double(const Trace&, const Trace& from)>;
double left_out(const Truth&, const Apart&, double solved_to = 0);

// ---- For truth_search.cpp

// difference of two references by that waveform, whose window begins at the instant `from` [s]; NaN
// if they have no such rows
double change(const Trace& more, const Trace& fewer, int tap, double from, std::size_t waveform);
struct Doubling {
    const Reference *coarse, *fine;
};
// Doublings of a profile's points, or of the modes, the coarsest first. If there are several from
// the same number of modes, the one with the most points, and vice versa.
std::vector<Doubling> doublings(const Truth&, bool points);
// The last one doubles to the truth itself.
bool ends_at_reference(const std::vector<Doubling>&, const Truth&);
// The estimate from these doublings, wherever the last one ends.
double left_by(const std::vector<Doubling>&, bool matched, const Apart&, double solved_to);
// Trust in a doubled truth; `solved` comes from the certificate.
Trust trust_of(const Trust& solved, const Truth&, double from);
// Motions with as many own modes as the matched reference has, and with half as many, both
// extrapolated.
std::vector<Trace> own_motion(const ReferenceChoice& matched, const Scene&, const Size&, int jobs,
                              const store::Listener&, double time_limit);

// ----

// Run with the cell's modes and compliance, or nullptr. `model`: the run with the default modes of
// cells (0: each scheme's own). A matched `model` serves cells of either compliance.
const Reference* of_modes(const Cell&, const Reference& model, const Truth&);

}  // namespace jvari::bench::study
