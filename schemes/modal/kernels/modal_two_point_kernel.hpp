// State and stepping kernel of the modal two-point scheme; the equations are told in modal_two_point.cpp.
//
// Each mode is scaled by sqrt(J/xi), so that one vector g both reads a contact point's displacement and receives its force
// (e = g), and is carried as (y, u), u the free increment of the step to come. One step is one pass over the modes:
//     f = sum_z g_z F_z,   s = u + f,   y <- y + s,   u <- s + f - loss s - c y,      c = 4A/J, loss = 2B/J
// (eqs 40-42 with q eliminated), which also gathers the dots g_z.y and g_z.u that the next step's contact forces need. The small numbers
// c = 1 - 2 R Omega + R^2 and loss = 1 - R^2 carry frequency and decay to full relative precision at any rate.
//
// With what the string lacks in series (contact/residual.hpp) the pass is the same, and so is the points' step: theta counts its K in.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "schemes/contact/contact.hpp"
#include "schemes/contact/residual.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

struct TwoPointTap {
    enum class From { modes, modes_and_increment, bridge, thread, driving } from;
    const double* on_y = nullptr;      // weights on y
    const double* on_u = nullptr;      // weights on u (velocity only)
    std::array<double, 3> on_force{};  // of barrier, thread and pluck at the instant: what is missing of a linear tap (series only)
};

// What stands in series with the string's points, and the pluck that acts on it.
struct TwoPointSeries {
    ResidualPair points;
    const double* pluck = nullptr;  // force at the instant pluck_first + n, n <= pluck_steps [N]
};

// The pass goes once through memory: a line of eight modes of each column, then the next eight. Lines of absent parts are never touched.
enum class TwoPointColumn { y, u, c, loss, g_b, g_c };
constexpr int two_point_line = 8, two_point_columns = 6;
constexpr std::ptrdiff_t two_point_at(TwoPointColumn column, std::ptrdiff_t mode) {
    return (mode / two_point_line * two_point_columns + static_cast<int>(column)) * two_point_line + mode % two_point_line;
}

struct TwoPoint {
    int modes = 0;
    int size = 0;                 // modes padded with zeros to a multiple of two_point_padding
    double* stream = nullptr;     // what a pass reads and writes, in its order: two_point_at
    const double* g_e = nullptr;  // pluck; nullptr where the scene has none
    const double* J = nullptr;    // energy only

    ContactLaw barrier;
    double h_b = 0;
    double k_c = 0, r_c = 0, h_c = 0;
    double dt = 0;
    double theta = 0, theta_bc = 0, theta_cc = 0, theta_be = 0, theta_ce = 0;  // theta_ze = g_z.g_e
    double phi_c = 0, inverse_c = 1, beta_c = 0;                               // 1/(1 + phi_c theta_cc)  (47)

    const double* pluck = nullptr;  // mean force of step pluck_first + n, n < pluck_steps [N]
    long pluck_first = 0, pluck_steps = 0;

    TwoPointSeries series;

    std::span<const TwoPointTap> taps;
    int steps_per_row = 1;

    // what changes from step to step
    long step = 0;
    double y_b = 0, y_c = 0, u_b = 0, u_c = 0;   // dots of the present state
    double impulse_b = 0, impulse_c = 0;         // sums of forces since the last row [N]
    double supplied = 0, dissipated = 0;         // since the last row [J]
    double least_force = 0, most_force = 0;      // over the run [N]
    double depth = 0;                            // [m]
    double iterations = 0, iterations_most = 0;  // of the contact solver
    Status status;
};

constexpr int two_point_padding = 16;

using TwoPointAdvance = Status (*)(TwoPoint&, const Block&);

// The kernel for these parts, in the widest vector instructions of this machine. It starts from the dots y_b .. u_c.
enum class ContactKind { none, linear, power };
enum class Compliance { own, matched };  // the modes' own, or with C in series

TwoPointAdvance two_point_kernel(ContactKind, bool thread, Compliance);

// Sum of w_i x_i over the padded modes, by the kernel's own instructions and order of summation.
double two_point_dot(const double* w, const double* x, int size);

}  // namespace jvari
