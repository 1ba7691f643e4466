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
// A scheme calls the pass, with any number of points. A kernel makes whole rows of it and of the
// obstacle's steps.
#pragma once

#include <cstddef>

#include "schemes/contact/obstacle.hpp"
#include "schemes/modal/kernels/fused_rows.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// A line of eight modes of each column, then the next eight: y, u, c, loss, then g of each point.
enum class TwoPointColumn { y, u, c, loss, g };
struct TwoPointStream {
    static constexpr int line = 8;
    int modes = 0;
    // modes padded with zeros to a multiple of modal_padding
    int size = 0;
    int points = 0;
    double* stream = nullptr;
    double *y = nullptr, *u = nullptr;  // dots of the present state with g of each point
    const double* theta = nullptr;      // g_z.g_w, row-major over the points
    double* sums = nullptr;             // workspace of many points: 2 x points x line
    long step = 0;
    long summed_again = 1;  // steps from one sum of g_z.y to the next

    int columns() const { return static_cast<int>(TwoPointColumn::g) + points; }
    std::ptrdiff_t at(TwoPointColumn column, std::ptrdiff_t mode, int point = 0) const {
        return (mode / line * columns() + static_cast<int>(column) + point) * line + mode % line;
    }
};
constexpr long two_point_summed_again = 16;  // in whole steps

using TwoPointPass = void (*)(TwoPointStream&, const double* force);
TwoPointPass two_point_pass(int points);

// Rows without a pluck, in the widest vector instructions of this machine. False: the caller wants
// no more.
using TwoPointKernel = bool (*)(TwoPointStream&, Obstacle&, const Block&, RowsInHand&);
TwoPointKernel two_point_kernel(int points, const Obstacle&);

// Sum of w and a column, over the padded modes.
using TwoPointDot = double (*)(const double* w, const TwoPointStream&, TwoPointColumn);
TwoPointDot two_point_dot();

}  // namespace jvari
