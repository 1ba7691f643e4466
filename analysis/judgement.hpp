// What is to be said against a run: its flags, whatever its error, and its outcome, as maps have
// it. The one definition of each judgement, which run, compare, suite, trim, maps, check and the
// page all use.
//
// The outcome of a run is the gravest that applies. Each threshold with its reason:
//   error           the scheme failed: it threw, its program ended with an error, or it took too
//                   long
//   refused         the scheme does not represent the scene, or not at these settings
//   diverged        the run's own status: an energy or a tap beyond what ten times the energy of
//                   the scene could make (schemes/run.hpp)
//   not_converged   the run's own status: the contact equation was left unsolved
//   energy_gaining  stored energy above the ledger (in which a negative loss counts as none:
//                   obstacles add no energy) by more than
//                   energy_allowed of E where the scheme promises a balance to rounding, 1e-2 where
//                   it promises none: there the true energy
//                   is no invariant, and wavers by O((omega dt)^2) in stable runs
//   adhesive        the contact pulls by more than pull_allowed of its largest push (below)
//   inaccurate      relative L2 error of the nut force over the run above 10 %: the headline signal
//                   of compare, and the threshold of its predictability horizon
//   flagged         none of these, but a flag speaks against it, as in a comparison: the ledger is
//                   open, psi is stuck, modes alias
//   unjudged        none of these, and no figure at all that could have told: no energy reported,
//                   no smallest contact force, no reference
//   sound           none of these, and at least one figure that would have told
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "schemes/run.hpp"

namespace jvari {

// What a run tells of itself beside its trace; NaN: unknown.
struct Figures {
    Status status;
    // relative to the largest stored energy; NaN unless probed
    double energy_residual_per_step, energy_residual_accumulated;
    // [N]; NaN where the scheme does not say
    double smallest_contact_force, largest_contact_force;
    double deepest_penetration;  // [m]
    // the largest excess of stored energy over the ledger, of the energy that was there
    // (energy.hpp)
    double energy_gain;
    double
        // of a tap over what the scene's energy can make of it (scenes/excitation.hpp) [1]; NaN
        // where no tap has a bound
        largest_over_bound;
    std::vector<Fact> facts;  // the others
};
Figures figures_of(Balance, const Scene&, int modes, const Run&);

// The part of its largest push with which a contact pulls; 0 where it pulls with pull_floor at
// most. NaN where `least` is unknown. An unknown `largest` counts as none, so any pull above the
// floor is then too much.
//
// The scale is the largest push, because stiffness, tension and amplitude may be of any size, and a
// rounding error grows with the forces. Most schemes never pull at all. sitar_waveguide pulls with
// 3e-8 of its largest push, by the rounding of its impulses, and the known-bad controls start at
// 1e-6. The floor stands for contacts that hardly touch: at 1e10 N/m, above every lumped obstacle
// of the library, the rounding of a displacement of 1 mm (1e-19 m) is a force of 1e-9 N.
double pull_of(double least, double largest);
constexpr double pull_allowed = 1e-6;
constexpr double pull_floor = 1e-9;  // [N]

// energy of a quadratised contact that is open, as sqrt(2V) over its largest
constexpr double psi_allowed = 1e-9;
// what the ledger may be open by, of the largest stored energy
constexpr double energy_allowed = 1e-6;
constexpr double error_allowed = 0.1;  // relative L2

struct Flags {  // what speaks against it, whatever its error
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
// nothing speaks against it, as far as its figures tell: sound or unjudged
bool is_trusted(Verdict);

Verdict verdict_of(const Figures&, Balance, double error);  // NaN: there is no error

}  // namespace jvari
