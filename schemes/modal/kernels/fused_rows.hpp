// Rows that a kernel makes by itself, of the steps of the modes and of the obstacle
// (fused_rows-inl.hpp), whatever the string in its modes.
#pragma once

namespace jvari {

struct FusedTap {
    // weights on two columns of the modes, y and u or a and b; nullptr: none
    const double *on_first = nullptr, *on_second = nullptr;
    // weights on the points' mean forces, and on the springs in series with them; nullptr: none
    const double *on_mean = nullptr, *on_series = nullptr;
};

struct RowsInHand {
    const FusedTap* taps;
    int first, end;  // rows of the block
    long steps_per_row;
    double* sum;            // of the points' forces since the last row [N]
    double* mean;           // workspaces: these over the steps,
    double* force;          // and the forces of the step
    long steps = 0;         // made
    bool converged = true;  // the last of them
};

}  // namespace jvari
