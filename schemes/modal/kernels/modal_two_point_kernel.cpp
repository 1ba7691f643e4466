// The pass of the modal two-point string, and its fused steps for one contact (van Walstijn et al.
// 2016, eqs 41-48), compiled once per instruction set by Highway. What a scene lacks is absent by a
// template argument, and so is what stands in series with the points.
#include "schemes/modal/kernels/modal_two_point_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/modal_two_point_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "schemes/modal/kernels/modal_two_point_pass-inl.hpp"
#include "schemes/modal/modal_string.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The pass of a step, which sums g_z.y now and then only.
template <bool barrier, bool thread, bool pluck>
HWY_INLINE void end_step(TwoPointStream& m, long summed_again, double F_b, double F_c, double F_e) {
    if (m.step++ % summed_again == 0) {
        pass<barrier, thread, pluck>(m, F_b, F_c, F_e);
        return;
    }
    if constexpr (barrier)  // (43)
        m.y_b += m.u_b + m.theta_bb * F_b + (thread ? m.theta_bc * F_c : 0) +
                 (pluck ? m.theta_be * F_e : 0);
    if constexpr (thread)  // (44)
        m.y_c += m.u_c + m.theta_cc * F_c + (barrier ? m.theta_bc * F_b : 0) +
                 (pluck ? m.theta_ce * F_e : 0);
    pass<barrier, thread, pluck, false>(m, F_b, F_c, F_e);
}
template <bool barrier, bool thread, bool pluck>
void pass_of(TwoPointStream& m, double F_b, double F_c, double F_e) {
    end_step<barrier, thread, pluck>(m, m.summed_again, F_b, F_c, F_e);
}

// A step with the obstacle's. False: it did not converge.
template <bool barrier, bool thread, bool in_series>
HWY_INLINE bool step(TwoPointStream& m, ContactAndThread& at, Residual* series, double* sum) {
    constexpr int c = barrier;  // of the thread among the points
    double y_b = m.y_b, y_c = m.y_c, u_b = m.u_b, u_c = m.u_c, F_b, F_c;
    if constexpr (in_series) {
        const double *yields = series->yields(0), *pulled = series->pulled();
        if constexpr (barrier) y_b += yields[0], u_b -= pulled[0];
        if constexpr (thread) y_c += yields[c], u_c -= pulled[c];
    }
    const bool converged = at.solve<barrier, thread>(y_b, y_b, u_b, y_c, u_c, F_b, F_c);
    if constexpr (barrier) sum[0] += F_b;
    if constexpr (thread) sum[c] += F_c;
    if constexpr (in_series) {
        const double F[2] = {barrier ? F_b : F_c, F_c};
        series->step<barrier + thread>(F);
    }
    end_step<barrier, thread, false>(m, two_point_summed_again, F_b, F_c, 0);
    return converged;
}

template <bool barrier, bool thread, bool in_series>
HWY_INLINE void write(const TwoPointStream& m, const Residual* series, const Block& out, int row,
                      TwoPointRows& r) {
    constexpr int points = barrier + thread;
    double mean[2] = {};
    const double* P = in_series ? series->force(0) : nullptr;
    for (int p = 0; p < points; ++p) {
        mean[p] = r.sum[p] / static_cast<double>(r.steps_per_row);
        r.sum[p] = 0;
    }
    for (int k = 0; k < out.taps; ++k) {
        const TwoPointTap& t = r.taps[k];
        double x = 0, of_P = 0;
        if (t.on_y) x += dot(t.on_y, m, Column::y);
        if (t.on_u) x += dot(t.on_u, m, Column::u);
        for (int p = 0; p < points; ++p) x += t.on_mean[p] * mean[p];
        for (int p = 0; in_series && p < points; ++p) of_P += t.on_P[p] * P[p];
        out.tap[k * out.stride + row] = in_series ? x + of_P : x;
    }
}

template <bool barrier, bool thread, bool in_series>
bool rows_of(TwoPointStream& m, ContactAndThread& at, Residual* series, const Block& out,
             TwoPointRows& r) {
    for (int row = r.first; row < r.end; ++row) {
        write<barrier, thread, in_series>(m, series, out, row, r);
        for (long i = 0; i < r.steps_per_row; ++i) {
            ++r.steps;
            if (!step<barrier, thread, in_series>(m, at, series, r.sum)) {
                r.converged = false;
                r.end = row + 1;
                return true;
            }
            if (out.stopped(i, steps_between_questions)) return false;
        }
    }
    return true;
}

template <bool barrier, bool thread>
TwoPointKernel choose_by_series(bool in_series) {
    if constexpr (barrier || thread)
        if (in_series) return rows_of<barrier, thread, true>;
    return rows_of<barrier, thread, false>;
}
TwoPointKernel choose_kernel(bool barrier, bool thread, bool in_series) {
    return barrier ? (thread ? choose_by_series<true, true>(in_series)
                             : choose_by_series<true, false>(in_series))
                   : (thread ? choose_by_series<false, true>(in_series)
                             : choose_by_series<false, false>(in_series));
}

TwoPointPass choose_pass(bool barrier, bool thread, bool pluck) {
    static constexpr TwoPointPass table[2][2][2] = {
        {{pass_of<false, false, false>, pass_of<false, false, true>},
         {pass_of<false, true, false>, pass_of<false, true, true>}},
        {{pass_of<true, false, false>, pass_of<true, false, true>},
         {pass_of<true, true, false>, pass_of<true, true, true>}}};
    return table[barrier][thread][pluck];
}

double dot_of_column(const double* w, const TwoPointStream& m, TwoPointColumn x) {
    return dot(w, m, x);
}
double plain_dot(const double* w, const double* x, int size) { return dot(w, x, size); }
TwoPointDot choose_dot() { return dot_of_column; }

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose_kernel);
HWY_EXPORT(choose_pass);
HWY_EXPORT(choose_dot);
HWY_EXPORT(plain_dot);

TwoPointKernel two_point_kernel(bool barrier, bool thread, bool in_series) {
    return HWY_DYNAMIC_DISPATCH(choose_kernel)(barrier, thread, in_series);
}
TwoPointPass two_point_pass(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_pass)(barrier, thread, pluck);
}
TwoPointDot two_point_dot() { return HWY_DYNAMIC_DISPATCH(choose_dot)(); }
double modal_dot(const AlignedVector& w, const AlignedVector& x) {
    return HWY_DYNAMIC_DISPATCH(plain_dot)(w.data(), x.data(), static_cast<int>(x.size()));
}
}  // namespace jvari
#endif
