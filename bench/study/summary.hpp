// What a run has to say of itself beside its trace.
#pragma once

#include <string>
#include <vector>

#include "schemes/run.hpp"

namespace jvari::bench::study {

struct Summary {
    std::string scheme, scene;
    double rate;  // [Hz]; NaN for a continuous-time reference
    int modes;    // of the first string; interior nodes for a scheme on a grid
    int dofs;
    long steps, rows;
    double duration;                                    // simulated [s]: up to the last valid row
    double wall_seconds, ns_per_step, times_real_time;  // NaN where there is nothing to divide
    double processor_seconds = 0;                       // of an accuracy run (cell.hpp)
    Status status;
    double energy_residual_per_step, energy_residual_accumulated;  // relative to the largest stored energy; NaN unless probed
    double smallest_contact_force, largest_contact_force;          // [N]; NaN where the scheme does not say
    double deepest_penetration;                                    // [m]
    double energy_gain;           // the largest excess of stored energy over the ledger, of the energy that was there (analysis/energy.hpp)
    double largest_displacement;  // of the displacement taps: |y| over sqrt(E L/(2T)), what that energy could make; NaN where there is none
    std::vector<Fact> facts;      // the others
};

Summary summary_of(const Descriptor&, const Scene&, const Settings&, const Run&);

// The value of a fact, NaN where the scheme does not report it. Where each of several strings has its own: the least of smallest contact
// forces, of any other the largest.
double fact(const std::vector<Fact>&, const std::string& name);
inline double fact(const std::vector<Fact>& all, const FactName& known) {
    return fact(all, known.name);
}

// ---- Flags: what the figures of a run say against it, whatever its error. A balance is necessary and never sufficient. This is the one
// definition of each judgement: run, compare, suite, trim, maps and check all use it.

struct Flag {
    std::string name;      // "adhesion"
    std::string sentence;  // what happened: "the contact pulls with 0.55 N, ..."
};
std::vector<Flag> flags_of(const Summary&);
std::string names_of(const std::vector<Flag>&);  // "adhesion psi_gap"; "" for none

// The part of its largest push with which a contact pulls; 0 where it pulls with pull_floor at most. NaN where `least` is unknown.
// An unknown `largest` counts as none, so any pull above the floor is then too much.
//
// The scale is the largest push, because stiffness, tension and amplitude may be of any size, and a rounding error grows with the forces.
// Most schemes never pull at all. sitar_waveguide pulls with 3e-8 of its largest push, by the rounding of its impulses, and the known-bad
// controls start at 1e-6. The floor stands for contacts that hardly touch: at 1e10 N/m, above every lumped obstacle of the library,
// the rounding of a displacement of 1 mm (1e-19 m) is a force of 1e-9 N.
double pull_of(double least, double largest);
constexpr double pull_allowed = 1e-6;
constexpr double pull_floor = 1e-9;  // [N]

constexpr double psi_allowed = 1e-9;     // energy of a quadratised contact that is open, as sqrt(2V) over its largest
constexpr double energy_allowed = 1e-6;  // what the ledger may be open by, of the largest stored energy

}  // namespace jvari::bench::study
