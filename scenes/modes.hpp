// Modes of the free string: simply supported ends, v_i(x) = sin(beta_i x), beta_i = i pi/L (van Walstijn et al. 2016, section 2.2).
#pragma once

#include <optional>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

struct Modes {
    double mass = 0;             // modal mass m = mu L/2 [kg], the same for all modes
    std::vector<double> beta;    // wavenumber [1/m]
    std::vector<double> omega0;  // undamped angular frequency [rad/s]
    std::vector<double> sigma;   // decay rate [1/s]
    int count() const { return static_cast<int>(beta.size()); }
};

constexpr int most_modes = 1 << 20;  // of a string

// The first `count` modes. Throws BadScene where a table of measured modes has fewer rows, or no string has as many.
Modes modes_of(const String&, int count);

// How many modes a table of measured modes has; absent: there is no table.
std::optional<int> modes_measured(const String&);

// How many modes have an undamped frequency below `hertz`, so that the number does not depend on the losses; it ends at most_modes + 1.
int modes_below(const String&, double hertz);

double omega_squared_damped(double omega0, double sigma);  // omega^2 = omega0^2 - sigma^2, negative where overdamped [rad^2/s^2]

// Weights w_i: a quantity is sum_i w_i y_i over the modal displacements y_i.
std::vector<double> displacement_weights(const Modes&, double position);             // v_i(x)
std::vector<double> footprint_weights(const Modes&, double position, double width);  // g_i, eq 20, limit at beta_i w = pi
std::vector<double> nut_force_weights(const Modes&, const String&);                  // -T v_i'(L) + EI v_i'''(L), eq 22 [N/m]

// Integral of linear density x v_i (1 - x/L): what a mode with both ends at rest feels of the acceleration of the end at x = 0, and that
// end of its own [kg].
std::vector<double> end_inertia(const Modes&, const String&);

// What a steady force of 1 N through these weights makes of the quantity they read [m/N]: sum_i w_i^2/(m omega0_i^2).
double static_compliance(const Modes&, const std::vector<double>& weights);

// Modal displacements at t = 0 [m]; zeros where the string has no initial shape.
std::vector<double> initial_displacement(const Modes&, const String&);

}  // namespace jvari
