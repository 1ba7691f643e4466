// Loop over a kernel's rows and steps. Highway compiles it once per instruction set.
#if defined(JVARI_MODAL_FUSED_ROWS) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_MODAL_FUSED_ROWS
#undef JVARI_MODAL_FUSED_ROWS
#else
#define JVARI_MODAL_FUSED_ROWS
#endif

#include <hwy/highway.h>

#include "schemes/modal/kernels/fused_rows.hpp"
#include "schemes/scheme.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {

// read(k): tap k's value from the modes; springs(): forces in the series springs; solve(force): the
// forces in a step, false if they were not found; pass(force): the modes' step. Returns false if
// the caller has abandoned the run.
template <class Read, class Springs, class Solve, class Pass>
HWY_INLINE bool make_rows(int points, double* force, const Block& out, RowsInHand& r,
                          const Read& read, const Springs& springs, const Solve& solve,
                          const Pass& pass) {
    for (int row = r.first; row < r.end; ++row) {
        for (int p = 0; p < points; ++p) {
            r.mean[p] = r.sum[p] / static_cast<double>(r.steps_per_row);
            r.sum[p] = 0;
        }
        const double* spring = springs();
        for (int k = 0; k < out.taps; ++k) {
            const FusedTap& t = r.taps[k];
            double x = read(k), of_springs = 0;
            for (int p = 0; t.on_mean && p < points; ++p) x += t.on_mean[p] * r.mean[p];
            for (int p = 0; t.on_series && p < points; ++p)
                of_springs += t.on_series[p] * spring[p];
            out.tap[k * out.stride + row] = t.on_series ? x + of_springs : x;
        }
        for (long i = 0; i < r.steps_per_row; ++i) {
            ++r.steps;
            const bool converged = solve(force);
            for (int p = 0; p < points; ++p) r.sum[p] += force[p];
            pass(force);
            if (!converged) {
                r.converged = false;
                r.end = row + 1;
                return true;
            }
            if (out.stopped(i, steps_between_questions)) return false;
        }
    }
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();
#endif
