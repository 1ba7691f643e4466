// Shared code for sitar_waveguide and sitar_fdm: the string on a grid that a wave crosses one cell
// per step, its bridge and its ledger.
//
// Source: Deshmukh & Rayavarapu, "2-D digital waveguide and finite difference modeling of a sitar",
// eqs 4 and 10-12.
//
// Geometry. x = 0 is the bridge end: the profile covers the nodes 0 < m dx <= x_c and the string
// may not pass below it. x = L is the peg, rigid. Node 0 is the termination itself and is not under
// the profile.
//
// Loss. The paper multiplies by a factor per period. Here every wave decays by step_loss =
// exp(-sigma dt) per step, with the scene's uniform decay rate sigma = -f0 ln(factor). This is the
// distortionless string y_tt + 2 sigma y_t + sigma^2 y = c^2 y_xx. The scene's string lacks the
// sigma^2 term, which moves its partials by sigma^2/(2 omega^2). The start y_r = y_l = y/2 has the
// velocity -sigma y; a fact reports the resulting phase error.
//
// Energy. A travelling wave f(x) carries T f'^2 per metre: stored = T/(4 dx) sum of squared
// differences over two cells. Over one cell the sum would also count a wave that alternates from
// sample to sample. The rails can hold such a wave of any size that is 0 at every node (y_r =
// -y_l), and no tap hears it.
//
// Bridge force. With y the displacement after the rule, the force on node m is the defect in its
// equation of motion: dt F = Z [y(n+1, m) - loss y(n, m+1) - loss y(n, m-1) + loss^2 y(n-1, m)], Z
// = T/c the wave impedance, 0 if no rule acts (eq 9).
#pragma once

#include <vector>

#include "schemes/contact/contact.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// Position of a tap: (1 - weight) at `node` and weight at the next.
struct SitarTap {
    Quantity quantity;
    int node = 0;
    double weight = 0;
};

struct SitarString {
    double length = 0;            // L [m]
    double tension = 0;           // T [N]
    double f0 = 0;                // first partial [Hz]
    double sigma = 0;             // uniform decay rate [1/s]
    double dt = 0;                // [s]
    double dx = 0;                // one cell, crossed in one step [m]
    int cells = 0;                // between the bridge end and the last node
    double step_loss = 1;         // exp(-sigma dt)
    std::vector<double> profile;  // height at nodes 1, 2, ... [m]
    std::vector<Fact> facts;      // deliberate approximations
    std::vector<SitarTap> taps;
    int steps_per_row = 1;
    String shape;  // from the scene: initial_shape() at t = 0

    // Modes on the grid: the wave moves from node to node in one step, so they are the modes of the
    // ideal string with this many cells.
    std::vector<FreeMode> free_modes() const;
    double impedance() const { return tension * dt / dx; }  // Z [kg/s]
    // sum of squared differences [m^2] -> [J]
    double wave_energy(double slopes) const { return 0.25 * tension / dx * slopes; }
};

// Sets everything but the grid (dx, cells) and its dependents. `stiffness` names the treatment of
// bending stiffness: "refuse", "ignore", or another word if the scheme includes it.
SitarString sitar_string(const Descriptor&, const Scene&, const Settings&,
                         const std::string& stiffness);

// Approximations: the barrier is rigid, and the string in these schemes lacks the sigma^2 term of a
// damped one.
constexpr Approximation sitar_damping{Feature::damping, facts::start_phase_error},
    sitar_profile{Feature::profile_barrier, facts::rigid_barrier},
    sitar_power_law{Feature::power_law_contact, facts::rigid_barrier},
    sitar_ignored_stiffness{Feature::bending_stiffness, facts::ignored_bending_stiffness};

// Integer length of eq 4: L/dx = round(fs/(2 f0)); its error is a fact.
void set_integer_length(SitarString&);
void refuse_too_many_cells(double cells);  // for any length: more than memory or an int holds

// Puts the profile on the nodes, once the grid is known. Refuses a bridge away from x = 0, shorter
// than a cell, or above the string at t = 0 (`plucked`: the share of the initial shape that lies in
// the bridge's plane).
void lay_bridge(SitarString&, double plucked);

// Shape at t = 0 [m], continued beyond both ends for the waves: odd about x = 0 and x = L.
double initial_shape(const String&, double x);

// Lattice of sitar_fdm with the rule of the reference (sitar_fdm.cpp).
std::unique_ptr<Scheme> characteristic_lattice_of(const Descriptor&, const Scene&, const Settings&);

void set_taps(SitarString&, const Scene&);
template <class AtNode>  // at(m): reading at node m
double between_nodes(const SitarTap& t, AtNode at) {
    const double here = at(t.node);
    return t.weight == 0 ? here : here + t.weight * (at(t.node + 1) - here);
}

// Energy and force that the bridge rule exchanged with the string.
struct BridgeLedger {
    double added = 0, taken = 0;  // energy over the run [J], both >= 0
    ForceRange force;             // over the steps [N]
    double impulse = 0;           // since the last row [N s]
    double dissipated = 0;        // by losses and the rule since the last row, with either sign [J]

    void exchange(double joules) {
        if (joules > 0) added += joules;
        else taken -= joules;
        dissipated -= joules;
    }
    void next_row() { impulse = dissipated = 0; }
    double mean(Quantity q, const SitarString& s) const {  // contact force over the last row [N]
        const double sign = q == Quantity::bridge_force ? 1 : q == Quantity::driving_force ? -1 : 0;
        return sign * impulse / (s.dt * s.steps_per_row);
    }
    void report(std::vector<Fact>&) const;
};

}  // namespace jvari
