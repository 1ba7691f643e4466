// Judges a run: its flags, whatever its error, and its outcome in maps. Each judgement is defined
// only here; run, compare, suite, trim, maps, check and the page all use it.
//
// The outcome of a run is the gravest that applies. Each threshold with its reason:
//   error           the scheme failed: it threw, its program ended with an error, or it took too
//                   long
//   refused         the scheme does not represent the scene, or not at these settings
//   diverged        the run's own status: an energy or a tap beyond the bound for ten times the
//                   scene's energy (schemes/run.hpp)
//   not_converged   the run's own status: the contact equation was left unsolved
//   energy_gaining  stored energy above the ledger (in which a negative loss counts as none:
//                   obstacles add no energy) by more than
//                   energy_allowed of E if the scheme promises a balance to rounding, 1e-2 if
//                   it promises none: there the true energy
//                   is no invariant, and wavers by O((omega dt)^2) in stable runs
//   adhesive        the contact pulls by more than pull_allowed of its largest push (below)
//   inaccurate      relative L2 error of the nut force over the run above 10 %: the headline signal
//                   of compare, and the threshold of its predictability horizon
//   flagged         none of these, but a flag counts against the run, as in a comparison: the
//                   ledger is open, psi is stuck, modes alias
//   unjudged        none of these, and no figure that could show a fault: no energy reported,
//                   no smallest contact force, no reference
//   sound           none of these, and at least one figure that would show a fault
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "schemes/run.hpp"

namespace jvari {

// Figures that a run reports beside its trace; NaN: unknown.
struct Figures {
    Status status;
    // relative to the largest stored energy; NaN unless probed
    double energy_residual_per_step, energy_residual_accumulated;
    // [N]; NaN if the scheme does not report it
    double smallest_contact_force, largest_contact_force;
    double deepest_penetration;  // [m]
    // largest excess of stored energy over the ledger, relative to the initial energy (energy.hpp)
    double energy_gain;
    double
        // ratio between a tap and the bound that the scene's energy allows (scenes/excitation.hpp)
        // [1]; NaN if no tap has a bound
        largest_over_bound;
    std::vector<Fact> facts;  // the others
};
Figures figures_of(Balance, const Scene&, int modes, const Run&);

// Ratio between a contact's pull and its largest push; 0 if the pull is at most pull_floor. NaN if
// `least` is unknown. An unknown `largest` counts for zero, so any pull above the floor is then too
// much.
//
// The scale is the largest push, because stiffness, tension and amplitude may have any size, and a
// rounding error grows with the forces. Most schemes never pull at all. sitar_waveguide pulls with
// 3e-8 times its largest push, by the rounding of its impulses, and the known-bad controls start at
// 1e-6. The floor covers contacts that hardly touch. At 1e10 N/m, above every lumped obstacle in
// the library, rounding a displacement of 1 mm (by 1e-19 m) gives a force of 1e-9 N.
double pull_of(double least, double largest);
constexpr double pull_allowed = 1e-6;
constexpr double pull_floor = 1e-9;  // [N]

// allowed error in a quadratised contact's energy, as sqrt(2V) over its largest value
constexpr double psi_allowed = 1e-9;
// allowed gap in the ledger, relative to the largest stored energy
constexpr double energy_allowed = 1e-6;
constexpr double error_allowed = 0.1;  // relative L2

struct Flags {  // faults in a run, whatever its error
    bool adhesion, psi_gap, energy, modes_above_nyquist;
    bool any() const { return adhesion || psi_gap || energy || modes_above_nyquist; }
};
Flags raised_by(const Figures&);

enum class Verdict {
    sound,
    unjudged,
    flagged,
    inaccurate,
    adhesive,
    energy_gaining,
    not_converged,
    diverged,
    refused,
    error
};
const char* name_of(Verdict);
Verdict verdict_named(const std::string&);  // throws std::runtime_error
// nothing went wrong with the run itself: sound or flagged
bool is_stable(Verdict);
// true if no figure counts against the run: sound or unjudged
bool is_trusted(Verdict);

Verdict verdict_of(const Figures&, Balance, double error);  // NaN: there is no error

}  // namespace jvari
