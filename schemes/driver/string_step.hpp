// What a string is between contacts: the motion of its step without the forces of its points, what
// it reads at them, and what they do to it. A new discretisation of the string is a class of this
// kind and a row of the table.
//
//     r_p = free_p + sum_q Theta_pq F_q        p = 0 .. P-1: contacts, then the thread
//
// is all that an obstacle has to know of a step (van Walstijn et al. 2016, eqs 44-48; Issanchou et
// al. 2016, eq 16): readings of the points at the older level, their increments to the newer one
// without forces, and the compliances Theta. levels = 1: a two-point step, from n to n+1. levels =
// 2: a three-point step, centred on n, from n-1 to n+1, and the string is stepped one ahead of its
// row: at row n it holds the levels n-1, n and n+1.
//
// The invariant: with `stored` the energy that belongs to the row (below), a step with forces F
// takes
//
//     stored(n) - stored(n-1) = supplied - dissipated + sum_p F_p r_p/levels,   dissipated >= 0
//
// to rounding. Of a two-point string `stored` is that of the instant n, of a three-point one that
// of the half step n + 1/2, which the forces of step n reach; docs/notation.md states this once for
// all schemes.
#pragma once

#include <concepts>
#include <optional>
#include <vector>

#include "schemes/contact/compliance.hpp"
#include "schemes/contact/obstacle.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

struct StringPoints {  // what a string is to whatever solves for its points
    Contacts contacts;
    // one at most, but of strings on a moving body (schemes/body/instrument.hpp)
    std::vector<Thread> threads;
    std::vector<Mass> masses;  // on the last contacts (free_masses.hpp); of their scene all taps
    std::vector<Tap> taps;
    std::vector<double> positions;  // x_p of each point [m], contacts first
    // row-major over the points, and then the moving body where there is one: [m/N], with the body
    // [s^2], of the body alone [kg s^2]
    std::vector<double> theta;
    // of the first half step of a three-point scheme; empty: half of theta
    std::vector<double> start_theta;
    std::optional<MissingMatrix> series;  // in series with the points, compliance=matched
    std::optional<Pluck> pluck;           //
    // at t = 0: the velocity of each point [m/s]; its force in equilibrium [N], none elsewhere
    std::vector<double> start_velocity, start_force;
    double mass = 0, length = 0, tension = 0;  // mu L [kg], L [m], T [N]
    double dt = 0;                             // [s]
    int count() const { return static_cast<int>(positions.size()); }
};
// of a scene's one string, without positions, contacts and theta
StringPoints points_of(const Scene&, double dt);

struct Place {  // of a contact: a node of a grid, or a footprint
    Footprint at;
    int node = 0;  // 0: none
};
// Adds the string's barriers and masses as contacts; of a profile each node of a grid of so many
// intervals is one, which stands for a spacing of it.
// Refusal where no node lies on a profile
std::vector<Place> add_contacts(StringPoints&, const String&, int intervals = 0);
// its barriers, which all are lumped, its masses and its thread
void add_lumped(StringPoints&, const String&);

// What a tap of contact forces hears of their means since the last row [N]; 0 of any other
// quantity.
inline double heard_force(Quantity quantity, const StringPoints& p, const double* mean) {
    double bridge = 0, thread = 0;
    for (int a = 0; a < p.contacts.count(); ++a) bridge += mean[a];
    for (int k = p.contacts.count(); k < p.count(); ++k) thread += mean[k];
    switch (quantity) {
        case Quantity::bridge_force: return bridge;
        case Quantity::thread_force: return thread;
        case Quantity::driving_force: return -(bridge + thread);
        default: return 0;
    }
}

// Of barriers one of which is rigid at least: refuses one that gives way beside it, and a start
// inside it.
void refuse_rigid(const Descriptor&, const StringPoints&, const double* reading_at_start);

// An equilibrium on contacts of an exponent other than 1.
void refuse_rest_in_powers(const Descriptor&, const StringPoints&);

struct Spent {                            // of one step
    double supplied = 0, dissipated = 0;  // by the pluck, and by the string's own losses [J]
};

template <class S>
concept StringStep = requires(S string, const S known, const double* force, double* out) {
    { S::levels } -> std::convertible_to<int>;                // 1 or 2
    { S::steps_between_looks } -> std::convertible_to<long>;  // (Block::stopped)
    { known.points() } -> std::same_as<const StringPoints&>;  //
    // t = 0 at rest; of two levels: the free motion to level 1, pluck included
    string.reset();
    // the next step without the points' forces; true: the last of its row
    string.approach(true);
    { known.readings() } -> std::same_as<ReadingsBeforeStep>;  // of that step
    // ends it by the forces and w'' of a moving body; true: `Spent` is asked for
    { string.pass(force, 0.0, true) } -> std::same_as<Spent>;
    // of the points at the instant of the row; 1: one step later
    string.reading(0, out);
    { string.stored() } -> std::same_as<double>;  // [J], without the points' potential
    { string.failed() } -> std::same_as<bool>;    // has diverged
    // tap k of the row; the means of the points' forces since the last one
    { string.tap(0, force) } -> std::same_as<double>;
    { known.dofs() } -> std::same_as<int>;                          //
    { known.facts() } -> std::same_as<std::vector<Fact>>;           //
    { known.free_modes() } -> std::same_as<std::vector<FreeMode>>;  //
};

// Of the points' forces in a step: 1, or 2 where they are lines in it. Then `free` and theta have
// the means of all points first and the first moments after them.
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
// A string may have fused_rows(out, row, sum): the rows from this one on whose steps the pluck does
// not act in, by a kernel that makes each step and the obstacle's in one. `sum` are the sums of the
// points' forces since the last row. They are what the driver makes of approach, Obstacle::solve,
// pass and tap, to the last bit. The obstacle comes by fuse(), before the first.
// Of three points also: start(force, a), which ends the first half step, and thread_start(). A
// string that a moving body can carry has inertia(), pluck(), momentum() and, of three points,
// share(): schemes/body/instrument.hpp.

}  // namespace jvari
