// Rows that a kernel makes alone, combining the steps of modes and obstacle (fused_rows-inl.hpp),
// for any string in its modes.
#pragma once

namespace jvari {

struct FusedTap {
    // weights on two columns in the modes, y and u or a and b; nullptr: none
    const double *on_first = nullptr, *on_second = nullptr;
    // weights on the points' mean forces, and on the springs in series with them; nullptr: none
    const double *on_mean = nullptr, *on_series = nullptr;
};

struct RowsInHand {
    const FusedTap* taps;
    int first, end;  // rows in the block
    long steps_per_row;
    double* sum;            // point forces since the last row [N]
    double* mean;           // workspaces: these over the steps,
    double* force;          // and the forces in the step
    long steps = 0;         // made
    bool converged = true;  // false after a failed solve
};

}  // namespace jvari
