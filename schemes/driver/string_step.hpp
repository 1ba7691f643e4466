// Interface of a string between contacts: its motion in a step without point forces, its readings
// at the points, and its response to forces there. A new discretisation of the string is a class
// with this interface and a row in the table.
//
//     r_p = free_p + sum_q Theta_pq F_q        p = 0 .. P-1: contacts, then the thread
//
// contains everything that an obstacle must know about a step (van Walstijn et al. 2016, eqs 44-48;
// Issanchou et al. 2016, eq 16): readings of the points at the older level, their increments to the
// newer one without forces, and the compliances Theta. levels = 1: a two-point step, from n to n+1.
// levels = 2: a three-point step, centred on n, from n-1 to n+1. The string is then stepped one
// ahead of its row: at row n it holds the levels n-1, n and n+1.
//
// The invariant: let `stored` be the energy that belongs to the row (below). A step with forces F
// then satisfies
//
//     stored(n) - stored(n-1) = supplied - dissipated + sum_p F_p r_p/levels,   dissipated >= 0
//
// to rounding. For a two-point string `stored` belongs to the instant n. For a three-point string
// it belongs to the half step n + 1/2, which the forces in step n reach; docs/notation.md states
// this once for all schemes.
#pragma once

#include <concepts>
#include <optional>
#include <vector>

#include "schemes/contact/compliance.hpp"
#include "schemes/contact/obstacle.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

struct StringPoints {  // a string in the form that the solver for its points needs
    Contacts contacts;
    // one at most, except for strings on a moving body (schemes/body/instrument.hpp)
    std::vector<Thread> threads;
    std::vector<Mass> masses;       // on the last contacts (free_masses.hpp)
    std::vector<Tap> taps;          // all taps in the scene
    std::vector<double> positions;  // x_p for each point [m], contacts first
    // row-major over the points, followed by the moving body if there is one. Units: [m/N] between
    // points, [s^2] with the body, [kg s^2] for the body alone
    std::vector<double> theta;
    // Theta in the first half step of a three-point scheme; empty: half of theta
    std::vector<double> start_theta;
    std::optional<MissingMatrix> series;  // in series with the points, compliance=matched
    std::optional<Pluck> pluck;           //
    // at t = 0: each point's velocity [m/s], and its force in equilibrium [N], absent otherwise
    std::vector<double> start_velocity, start_force;
    double mass = 0, length = 0, tension = 0;  // mu L [kg], L [m], T [N]
    double dt = 0;                             // [s]
    int count() const { return static_cast<int>(positions.size()); }
};
// Points of the only string in a scene, without positions, contacts and theta.
StringPoints points_of(const Scene&, double dt);

struct Place {  // position of a contact: a grid node, or a footprint
    Footprint at;
    int node = 0;  // 0: none
};
// Adds the string's barriers and masses as contacts. On a profile each node of a grid with this
// many intervals is a contact and stands for one grid spacing. Refusal if a profile contains no
// node.
std::vector<Place> add_contacts(StringPoints&, const String&, int intervals = 0);
// Adds the string's barriers, which all are lumped, its masses and its thread.
void add_lumped(StringPoints&, const String&);

// Value of a contact-force tap from the mean forces since the last row [N]; 0 for any other
// quantity.
inline double heard_force(Quantity quantity, const StringPoints& p, const double* mean) {
    double bridge = 0, thread = 0;
    for (int a = 0; a < p.contacts.count(); ++a) bridge += p.contacts.sign[a] * mean[a];
    for (int k = p.contacts.count(); k < p.count(); ++k) thread += mean[k];
    switch (quantity) {
        case Quantity::bridge_force: return bridge;
        case Quantity::thread_force: return thread;
        case Quantity::driving_force: return -(bridge + thread);
        default: return 0;
    }
}

// Checks barriers among which at least one is rigid: refuses a yielding barrier beside it, and a
// start inside it.
void refuse_rigid(const Descriptor&, const StringPoints&, const double* reading_at_start);

// Refuses an equilibrium on contacts with an exponent other than 1.
void refuse_rest_in_powers(const Descriptor&, const StringPoints&);

struct Spent {                            // energies in one step
    double supplied = 0, dissipated = 0;  // by the pluck, and by the string's own losses [J]
};

template <class S>
concept StringStep = requires(S string, const S known, const double* force, double* out) {
    { S::levels } -> std::convertible_to<int>;                // 1 or 2
    { S::steps_between_looks } -> std::convertible_to<long>;  // (Block::stopped)
    { known.points() } -> std::same_as<const StringPoints&>;  //
    // t = 0 at rest; with two levels: the free motion to level 1, including the pluck
    string.reset();
    // the next step without point forces; true: the last step in its row
    string.approach(true);
    { known.readings() } -> std::same_as<ReadingsBeforeStep>;  // for that step
    // ends the step with the forces and w'' of a moving body; true: `Spent` is needed
    { string.pass(force, 0.0, true) } -> std::same_as<Spent>;
    // readings at the points at the row's instant; 1: one step later
    string.reading(0, out);
    { string.stored() } -> std::same_as<double>;  // [J], without the points' potential
    { string.failed() } -> std::same_as<bool>;    // has diverged
    // tap k at the row; mean point forces since the last row
    { string.tap(0, force) } -> std::same_as<double>;
    { known.dofs() } -> std::same_as<int>;                          //
    { known.facts() } -> std::same_as<std::vector<Fact>>;           //
    { known.free_modes() } -> std::same_as<std::vector<FreeMode>>;  //
};

// Number of moments of the point forces in a step: 1, or 2 if the forces are lines in the step. In
// that case `free` and theta list the means for all points first and the first moments after them.
template <class S>
constexpr int moments_of = [] {
    if constexpr (requires { S::moments; }) return S::moments;
    else return 1;
}();

struct FusedRows {
    int rows = 0;
    long steps = 0;  // 0: the row cannot be made so
    bool converged = true, stopped = false;
};
// Fused rows: a string may have fused_rows(out, row, sum). It makes the rows from this one on in
// whose steps the pluck does not act, by a kernel that combines each step with the obstacle's.
// `sum` holds the sums of the point forces since the last row. The result equals the driver's
// result from approach, Obstacle::solve, pass and tap to the last bit. fuse() passes the obstacle,
// before the first row. A string with three points also has start(force, a), which ends the first
// half step, and thread_start(). A string that a moving body can carry has inertia(), pluck(),
// momentum() and, with three points, share(): schemes/body/instrument.hpp.

}  // namespace jvari
