// What the modes of a string have at t = 0: of a shape, of a file, or of the static equilibrium.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scenes/modes.hpp"

namespace jvari {

struct ModalStart {
    std::vector<double> displacement, velocity;  // of each mode [m], [m/s]
    // of barriers and thread on a string that starts in equilibrium [N]; else none
    std::vector<double> force;
};

// How a scheme's string yields under steady forces, where not as its modes do. Empty: as they do.
struct Yield {
    std::span<const double> modes = {};   // of each mode under 1 N on it [m/N]; 1/(m omega0^2)
    std::span<const double> series = {};  // beside the modes: barriers and thread, squared [m/N]
    std::span<const double> pluck = {};   // of each of these points by 1 N of the pluck [m/N]
};

// The equilibrium: barriers push by k [h - y]^exponent, the thread pulls by k (h - y), and the
// pluck pushes as it does at t = 0. A profile acts in the middles of 32 equal parts. Throws
// BadScene where Newton's steps do not find it.
ModalStart start_of(const Modes&, const String&, const Yield& = {});

// At x [m]: of a table that is no table of modes the straight lines, of modes their sum.
double displacement_at(const TableStart&, double length, double x);

// The nut force [N] at t = 0 of a stiff string that is let go from a sharp corner: that of the
// shape, T A/(L - x0). What its modes sum up to then has no limit, for its bending energy has none.
// Nothing where no string that the tap hears starts so, or where its tension grows.
std::optional<double> force_of_a_corner(const Scene&, const Tap&);

double largest_displacement(const String&);  // of its start, 0 of an equilibrium [m]

// With displacement, velocity and pluck times `factor`; an equilibrium stays as it is.
String scaled(String, double factor);

// ---- The forces F >= 0 of contacts at rest, h_p - sum_q C_pq F_q = (F_p/k_p)^(1/exponent_p) where
// F_p > 0.

struct RestingPoint {
    double stiffness = 0;  // [N/m^exponent], or rigid
    double exponent = 1;
    double height = 0;       // above the string without these forces [m]
    bool both_ways = false;  // a spring that pulls as well
};
// C: row-major [m/N]. None where Newton's steps do not end.
std::vector<double> resting_forces(std::span<const RestingPoint>, std::span<const double> C);

}  // namespace jvari
