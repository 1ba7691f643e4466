// Modes of the free string: simply supported ends, v_i(x) = sin(beta_i x), beta_i = i pi/L (van
// Walstijn et al. 2016, section 2.2).
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

constexpr int most_modes = 1 << 20;  // no string has more

// The first `count` modes. Throws BadScene if a table of measured modes has fewer rows, or if count
// > most_modes.
Modes modes_of(const String&, int count);

// Number of measured modes; nothing if the string has no table of them.
std::optional<int> modes_measured(const String&);

// Number of modes whose undamped frequency is below `hertz`, at most most_modes + 1. Independent of
// the losses.
int modes_below(const String&, double hertz);

// omega0^2 - sigma^2 [rad^2/s^2], negative if the mode is overdamped
double omega_squared_damped(double omega0, double sigma);

// Weights w_i of a quantity: it is sum_i w_i y_i, with the modal displacements y_i.
std::vector<double> displacement_weights(const Modes&, double position);  // v_i(x)
// g_i, eq 20, limit at beta_i w = pi; sign: -1 for the coordinate of a contact from above
std::vector<double> footprint_weights(const Modes&, double position, double width, double sign = 1);
std::vector<double> contact_weights(const Modes&, const LumpedBarrier&);  // with its sign
// -T v_i'(L) + EI v_i'''(L), eq 22 [N/m]
std::vector<double> nut_force_weights(const Modes&, const String&);

// The same weights, and 0 for modes that are not below that frequency [Hz].
std::vector<double> weights_below(double hertz, std::vector<double> weights, const Modes&);

// Coupled mass between each mode and the end at x = 0 [kg], the integral of mu v_i (1 - x/L): it
// multiplies the end's acceleration in the mode's equation, and the mode's acceleration in the
// end's.
std::vector<double> end_inertia(const Modes&, const String&);

// Value of the quantity with these weights under a steady force of 1 N through the same weights
// [m/N]: sum_i w_i^2/(m omega0_i^2).
double static_compliance(const Modes&, const std::vector<double>& weights);

}  // namespace jvari
