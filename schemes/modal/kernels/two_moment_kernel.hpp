// State and kernels for a string in its modes under forces that are lines in the step;
// two_moment_modes.hpp has the equations.
//
// One step is one pass over the modes: forces (2), the turn to the next centre (3), and the sums
// (1) that the next step's forces need. Whole rows include the obstacle's steps.
#pragma once

#include <cstddef>

#include "schemes/modal/kernels/fused_rows.hpp"
#include "schemes/moments/moment_obstacle.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// Stream layout: a line with eight modes from each column, then the next eight: a, b, A11, A12,
// A22, then p_0 for each point, then p_1 for each.
struct TwoMomentStream {
    enum Column { a, b, A11, A12, A22, weights };
    static constexpr int line = 8;
    int modes = 0, size = 0;  // size: padded with zeros to a multiple of modal_padding
    int points = 0;
    bool thread = false;  // the last point
    double* stream = nullptr;
    double* free = nullptr;  // moments at the points without forces, for the coming step

    int columns() const { return weights + 2 * points; }
    std::ptrdiff_t at(int column, std::ptrdiff_t mode) const {
        return (mode / line * columns() + column) * line + mode % line;
    }
};

// Makes a step of the modes; phi: means for all points, then first moments.
using TwoMomentPass = void (*)(TwoMomentStream&, const double* phi);
TwoMomentPass two_moment_pass(int points, bool thread);

// False: the caller wants no more.
using TwoMomentRowsKernel = bool (*)(TwoMomentStream&, MomentObstacle&, const Block&, RowsInHand&);
TwoMomentRowsKernel two_moment_rows(int points, bool thread, bool series);

// Sum over on_a a + on_b b, over the padded modes.
using TwoMomentSum = double (*)(const double* on_a, const double* on_b, const TwoMomentStream&);
TwoMomentSum two_moment_sum();

}  // namespace jvari
