// State of a string's modes at t = 0: from a shape, a file, or the static equilibrium.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scenes/modes.hpp"

namespace jvari {

struct ModalStart {
    std::vector<double> displacement, velocity;  // for each mode [m], [m/s]
    // forces from barriers and thread on a string that starts in equilibrium [N]; empty otherwise
    std::vector<double> force;
};

// Compliance of a scheme's string under steady forces, if it differs from the compliance in its
// modes. An empty field means the modal compliance.
struct Yield {
    // each mode's displacement under 1 N on it [m/N]; 1/(m omega0^2)
    std::span<const double> modes = {};
    std::span<const double> series = {};  // beside the modes: barriers and thread, squared [m/N]
    // each point's displacement under 1 N from the pluck [m/N]
    std::span<const double> pluck = {};
};

// The equilibrium balances three forces: barriers push by k [h - y]^exponent, the thread pulls by k
// (h - y), and the pluck pushes with its force at t = 0. A profile acts in the middles of 32 equal
// parts. Throws BadScene if Newton's steps do not find the equilibrium.
ModalStart start_of(const Modes&, const String&, const Yield& = {});

// Displacement at x [m]: straight lines between table rows, or the sum for a table that lists
// modes.
double displacement_at(const TableStart&, double length, double x);

// Nut force [N] at t = 0 for a stiff string released from a sharp corner: the force of the shape, T
// A/(L - x0). The modal sum at that instant has no limit, because the bending energy has none.
// Empty if no string that the tap hears starts this way, or if its tension grows.
std::optional<double> force_of_a_corner(const Scene&, const Tap&);

// largest value in the initial shape, 0 for an equilibrium [m]
double largest_displacement(const String&);

// Multiplies displacement, velocity and pluck by `factor`; an equilibrium stays unchanged.
String scaled(String, double factor);

// ---- Contact forces F >= 0 at rest, from h_p - sum_q C_pq F_q = (F_p/k_p)^(1/exponent_p) for all
// p with F_p > 0.

struct RestingPoint {
    double stiffness = 0;  // [N/m^exponent], or rigid
    double exponent = 1;
    double height = 0;       // above the string without these forces [m]
    bool both_ways = false;  // true for a spring that also pulls
};
// C: row-major [m/N]. Returns no forces if Newton's steps do not end.
std::vector<double> resting_forces(std::span<const RestingPoint>, std::span<const double> C);

}  // namespace jvari
