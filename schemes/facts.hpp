// Facts that schemes and references report about a run, each with its unit and its meaning: `jvari
// list facts` prints the table.
//
// A scheme reports {facts::grid_intervals, value}; the program finds a fact again by the same
// constant. With several strings each reports its own, "string.<k>." before the name. A plugin may
// report facts outside this table.
#pragma once

#include <span>

namespace jvari {

struct FactName {
    const char *name, *unit, *meaning;  // unit "": a plain number
};

// clang-format off
#define JVARI_FACTS(FACT) \
    FACT(smallest_contact_force, "N", \
         "least force that a contact put on the string; below 0 it pulls") \
    FACT(largest_contact_force, "N", "greatest force that a contact put on the string") \
    FACT(deepest_penetration, "m", "deepest that the string went below an obstacle's surface") \
    FACT(contact_points, "", "points at which the obstacle's force acts") \
    FACT(conserving_contacts, "", \
         "contacts by the rule that conserves energy in a step (G); the others by rule D") \
    FACT(constant_force_steps, "", \
         "steps with constant contact forces, since lines were not found") \
    FACT(contact_solves, "", "contact equations solved") \
    FACT(coupled_contact_points, "", \
         "points whose forces are solved for together: what a step of a dense contact costs " \
         "grows with their cube") \
    FACT(contact_iterations_mean, "", "iterations of the contact solver, mean over the steps") \
    FACT(contact_iterations_most, "", "iterations of the contact solver, most in one step") \
    FACT(contact_residual, "", "largest residual that the contact solver left") \
    FACT(static_compliance, "", \
         "deflection under a steady force at the barrier, over that of the scene's string") \
    FACT(series_compliance, "m/N", "compliance in series with the first contact") \
    FACT(compliance_excess, "m/N", \
         "most that a scheme's string yields more than the true one under a load on several " \
         "contacts: no spring in series takes that away") \
    FACT(start_phase_offset, "rad", \
         "largest phase by which a mode leads the true motion after a start at rest") \
    FACT(modes_above_nyquist, "", "modes at or above half the sample rate, which alias") \
    FACT(interior_nodes, "", "nodes of the grid between the ends") \
    FACT(grid_intervals, "", "intervals of the grid from end to end") \
    FACT(spacing_over_limit, "", "spacing of the grid over the least that is stable") \
    FACT(theta, "", "theta of the implicit scheme") \
    FACT(narrowest_contact, "cells", "narrowest footprint of a barrier or thread on the grid") \
    FACT(loss_fit_sigma0, "1/s", "fitted loss 2 sigma0 u_t") \
    FACT(loss_fit_sigma1, "m^2/s", "fitted loss -2 sigma1 u_xxt") \
    FACT(loss_fit_sigma2, "m^4/s", "fitted loss 2 sigma2 u_xxxxt") \
    FACT(loss_fit_misfit, "", "relative misfit of the fitted loss to the scene's") \
    FACT(stable_stiffness_limit, "N/m", \
         "contact stiffness above which lasting contact is unstable") \
    FACT(psi_gap, "", "largest |psi - sqrt(2V)| over the largest sqrt(2V)") \
    FACT(psi_out_of_contact, "", "the same where the string is clear of the barrier") \
    FACT(energy_gap, "J", "largest difference of the energy with psi from the true one") \
    FACT(rigid_barrier, "", "1: the barrier is rigid, its stiffness and exponent play no part") \
    FACT(rigid_stiffness, "N/m", \
         "stiffness of the stiffest spring that stands for a rigid barrier") \
    FACT(bridge_nodes, "", "nodes under the bridge") \
    FACT(bridge_length_error, "m", "length of the bridge on the grid less the scene's") \
    FACT(bridge_energy_added, "J", "energy that the bridge rule gave the string") \
    FACT(bridge_energy_taken, "J", "energy that the bridge rule took from the string") \
    FACT(start_phase_error, "rad", "phase by which a start at -sigma y leads one at rest") \
    FACT(ignored_bending_stiffness, "N m^2", "bending stiffness of the scene that plays no part") \
    FACT(period_error_cents, "cents", "error of the first partial's period") \
    FACT(worst_partial_error_cents, "cents", \
         "largest error of a partial that the filter at the peg is tuned to") \
    FACT(length_in_filter, "m", "length of string that the filter at the peg stands for") \
    FACT(taps_between_nodes, "", "taps read between two nodes by linear interpolation") \
    FACT(events, "", "contacts made and lost") \
    FACT(windows, "", "windows between two looks at the modes") \
    FACT(window_terms, "", "derivatives that a window keeps") \
    FACT(contact_steps, "", "steps of contact by collocation") \
    FACT(detection_tolerance, "m", "penetration that may pass unseen in the motion computed") \
    FACT(integrator_steps, "", "steps of the integrator") \
    FACT(slope_evaluations, "", "evaluations of the equations' right side") \
    FACT(linear_solves, "", "linear systems solved") \
    FACT(integrator_tolerance, "", "relative tolerance of the integrator")
// clang-format on

namespace facts {
#define JVARI_FACT(name, unit, meaning) inline constexpr FactName name{#name, unit, meaning};
JVARI_FACTS(JVARI_FACT)
#undef JVARI_FACT

#define JVARI_FACT(name, unit, meaning) name,
inline constexpr FactName table[] = {JVARI_FACTS(JVARI_FACT)};
#undef JVARI_FACT
}  // namespace facts

}  // namespace jvari
