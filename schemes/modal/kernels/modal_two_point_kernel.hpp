// State and stepping kernels for a string in its modes by two-point steps; two_point_modes.hpp has
// the equations.
//
// Each mode is scaled by sqrt(J/xi), so that one vector g both reads a contact point's displacement
// and receives its force (e = g). The mode is carried in (y, u), u the free increment in the coming
// step. One step is one pass over the modes:
//     f = sum_z g_z F_z,   s = u + f,   y <- y + s,   u <- s + f - loss s - c y,
//     c = 4A/J, loss = 2B/J
// (van Walstijn et al. 2016, eqs 40-42 with q eliminated), which also gathers the dots g_z.y and
// g_z.u that the next step's contact forces need. g_z.y follows without a sum, y_z <- y_z + u_z +
// sum_w theta_zw F_w (40, 41): whole steps sum g_z.y only now and then, against roundings. The
// small numbers c = 1 - 2 R Omega + R^2 and loss = 1 - R^2 carry frequency and decay to full
// relative precision at any rate.
//
// A scheme calls the pass, with any number of points. A kernel combines the pass and the obstacle's
// steps into whole rows.
#pragma once

#include <cstddef>

#include "schemes/contact/obstacle.hpp"
#include "schemes/modal/kernels/fused_rows.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// Stream layout: a line with eight modes from each column, then the next eight: y, u, c, loss, then
// g for each point.
enum class TwoPointColumn { y, u, c, loss, g };
struct TwoPointStream {
    static constexpr int line = 8;
    int modes = 0;
    // modes padded with zeros to a multiple of modal_padding
    int size = 0;
    int points = 0;
    double* stream = nullptr;
    double *y = nullptr, *u = nullptr;  // dots between the present state and g for each point
    const double* theta = nullptr;      // g_z.g_w, row-major over the points
    double* sums = nullptr;             // workspace for many points: 2 x points x line
    long step = 0;
    long summed_again = 1;  // steps between two sums of g_z.y

    int columns() const { return static_cast<int>(TwoPointColumn::g) + points; }
    std::ptrdiff_t at(TwoPointColumn column, std::ptrdiff_t mode, int point = 0) const {
        return (mode / line * columns() + static_cast<int>(column) + point) * line + mode % line;
    }
};
constexpr long two_point_summed_again = 16;  // in whole steps

using TwoPointPass = void (*)(TwoPointStream&, const double* force);
TwoPointPass two_point_pass(int points);

// Makes rows without a pluck, by the widest vector instructions on this machine. False: the caller
// has abandoned the run.
using TwoPointKernel = bool (*)(TwoPointStream&, Obstacle&, const Block&, RowsInHand&);
TwoPointKernel two_point_kernel(int points, const Obstacle&);

// Sum over w times a column, over the padded modes.
using TwoPointDot = double (*)(const double* w, const TwoPointStream&, TwoPointColumn);
TwoPointDot two_point_dot();

}  // namespace jvari
