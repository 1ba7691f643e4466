// State and stepping kernels of a string in its modes by two-point steps; two_point_modes.hpp has
// the equations.
//
// Each mode is scaled by sqrt(J/xi), so that one vector g both reads a contact point's displacement
// and receives its force (e = g), and is carried as (y, u), u the free increment of the step to
// come. One step is one pass over the modes:
//     f = sum_z g_z F_z,   s = u + f,   y <- y + s,   u <- s + f - loss s - c y,
//     c = 4A/J, loss = 2B/J
// (van Walstijn et al. 2016, eqs 40-42 with q eliminated), which also gathers the dots g_z.y and
// g_z.u that the next step's contact forces need. g_z.y follows without a sum, y_z <- y_z + u_z +
// sum_w theta_zw F_w (40, 41): whole steps sum it only now and then, against roundings. The small
// numbers c = 1 - 2 R Omega + R^2 and loss = 1 - R^2 carry frequency and decay to full relative
// precision at any rate.
//
// A scheme calls the pass. Where one contact by the discrete gradient and a thread are all that it
// touches, a kernel makes whole steps of it: those of obstacle.hpp with what is in series, and the
// pass.
#pragma once

#include <cstddef>

#include "schemes/contact/eliminated_thread.hpp"
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
    // theta_zw = g_z.g_w
    double theta_bb = 0, theta_bc = 0, theta_cc = 0, theta_be = 0, theta_ce = 0;
    long step = 0;
    long summed_again = 1;  // steps from one sum of g_z.y to the next
};
constexpr long two_point_summed_again = 16;  // in whole steps

using TwoPointPass = void (*)(TwoPointStream&, double F_b, double F_c, double F_e);
TwoPointPass two_point_pass(bool barrier, bool thread, bool pluck);

struct TwoPointTap {                                // what a tap hears of a row:
    const double *on_y = nullptr, *on_u = nullptr;  // weights on the modes; nullptr: none
    // of the means of the forces of contact and thread, as far as there are any, and of the springs
    // in series with them
    double on_mean[2] = {}, on_P[2] = {};
};
struct TwoPointRows {
    const TwoPointTap* taps;
    int first, end;  // rows of the block
    long steps_per_row;
    double* sum;            // of the points' forces since the last row [N]
    long steps = 0;         // made
    bool converged = true;  // the last of them
};
// Rows without a pluck, in the widest vector instructions of this machine, from the dots y_b ..
// u_c. False: the caller wants no more.
using TwoPointKernel = bool (*)(TwoPointStream&, ContactAndThread&, Residual*, const Block&,
                                TwoPointRows&);
TwoPointKernel two_point_kernel(bool barrier, bool thread, bool in_series);

// Sum of w and a column, over the padded modes.
using TwoPointDot = double (*)(const double* w, const TwoPointStream&, TwoPointColumn);
TwoPointDot two_point_dot();

}  // namespace jvari
