// State and stepping kernels of a string in its modes by two-point steps; two_point_modes.hpp has
// the equations.
//
// Each mode is scaled by sqrt(J/xi), so that one vector g both reads a contact point's displacement
// and receives its force (e = g), and is carried as (y, u), u the free increment of the step to
// come. One step is one pass over the modes:
//     f = sum_z g_z F_z,   s = u + f,   y <- y + s,   u <- s + f - loss s - c y,      c = 4A/J,
//                          loss = 2B/J
// (van Walstijn et al. 2016, eqs 40-42 with q eliminated), which also gathers the dots g_z.y and
// g_z.u that the next step's contact forces need. g_z.y follows without a sum, y_z <- y_z + u_z +
// sum_w theta_zw F_w (40, 41): whole steps sum it only now and then, against roundings. The small
// numbers c = 1 - 2 R Omega + R^2 and loss = 1 - R^2 carry frequency and decay to full relative
// precision at any rate.
//
// Whoever drives the string calls the pass. One contact by the discrete gradient, with a thread,
// has whole steps in one kernel, points and pass. With what the string lacks in series
// (contact/residual.hpp) they are the same: theta counts its K in.
#pragma once

#include <cstddef>
#include <span>

#include "schemes/contact/contact.hpp"
#include "schemes/contact/residual.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// The pass goes once through memory: a line of eight modes of each column, then the next eight.
// Lines of absent parts are never touched.
enum class TwoPointColumn { y, u, c, loss, g_b, g_c };
constexpr int two_point_line = 8, two_point_columns = 6;
constexpr std::ptrdiff_t two_point_at(TwoPointColumn column, std::ptrdiff_t mode) {
    return (mode / two_point_line * two_point_columns + static_cast<int>(column)) * two_point_line +
           mode % two_point_line;
}

struct TwoPointStream {
    int modes = 0;
    // modes padded with zeros to a multiple of modal_padding
    int size = 0;
    // what a pass reads and writes, in its order: two_point_at
    double* stream = nullptr;
    const double* g_e = nullptr;                // pluck; nullptr where the scene has none
    double y_b = 0, y_c = 0, u_b = 0, u_c = 0;  // dots of the present state
};
using TwoPointPass = void (*)(TwoPointStream&, double F_b, double F_c, double F_e);
TwoPointPass two_point_pass(bool barrier, bool thread, bool pluck);

// Sum of w and a column, over the padded modes.
double two_point_dot(const double* w, const TwoPointStream&, TwoPointColumn);

// ---- Rows of one contact at most, and a thread.

constexpr long two_point_summed_again = 16;  // steps from one sum of g_z.y to the next

struct TwoPointTap {                                // what a tap hears of a row:
    const double *on_y = nullptr, *on_u = nullptr;  // weights on the modes; nullptr: none
    // of the means of the forces of contact and thread since the last row
    double on_b = 0, on_c = 0;
    // of the springs in series with them, and of the pluck at the instant
    double on_P_b = 0, on_P_c = 0, on_e = 0;
};

struct TwoPoint : TwoPointStream {
    ContactLaw barrier;
    double h_b = 0;
    double k_c = 0, r_c = 0, h_c = 0;
    double dt = 0;
    double theta = 0, theta_bc = 0, theta_cc = 0, theta_be = 0, theta_ce = 0;  // theta_ze = g_z.g_e
    // theta_zw = g_z.g_w, of the modes alone
    double own_bb = 0, own_bc = 0, own_cc = 0;
    // 1/(1 + phi_c theta_cc)  (47)
    double phi_c = 0, inverse_c = 1, beta_c = 0;

    const double* pluck = nullptr;  // mean force of step pluck_first + n, n < pluck_steps [N]
    // force at the instant pluck_first + n, n <= pluck_steps [N]; where something is in series
    const double* pluck_now = nullptr;
    long pluck_first = 0, pluck_steps = 0;
    std::span<const TwoPointTap> taps;
    int steps_per_row = 1;

    // what changes from step to step
    ResidualPair series;
    long step = 0;
    double impulse_b = 0, impulse_c = 0;         // sums of forces since the last row [N]
    double supplied = 0, dissipated = 0;         // since the last row [J]
    ForceRange range;                            // over the run
    double depth = 0;                            // [m]
    double iterations = 0, iterations_most = 0;  // of the contact solver
    Status status;
};

// Writes the taps of a row and makes its steps, in the widest vector instructions of this machine,
// from the dots y_b .. u_c. False: the caller wants no more.
using TwoPointRow = bool (*)(TwoPoint&, const Block&, int row);
enum class ContactKind { none, linear, power };
enum class Compliance { own, matched };  // the modes' own, or with C in series
TwoPointRow two_point_row(ContactKind, bool thread, Compliance);

}  // namespace jvari
