// The pass of the modal two-point string, and its fused rows (van Walstijn et al. 2016, eqs 41-48),
// compiled once per instruction set by Highway. The number of points up to five, and of one contact
// and a thread what stands in series with them, are template arguments: what a scene lacks costs
// nothing.
#include "schemes/modal/kernels/modal_two_point_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/modal_two_point_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "schemes/modal/kernels/fused_rows-inl.hpp"
#include "schemes/modal/kernels/modal_two_point_pass-inl.hpp"
#include "schemes/modal/modal_string.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The pass of a step, which sums g_z.y now and then only.
template <int points>
HWY_INLINE void end_step(TwoPointStream& m, long summed_again, const double* force) {
    if (m.step++ % summed_again == 0) {
        pass<points, true>(m, force);
        return;
    }
    const int n = points == any_number ? m.points : points;
    for (int p = 0; p < n; ++p) {  // (43), (44)
        const double* theta = m.theta + p * n;
        double moved = m.u[p] + theta[p] * force[p];
        for (int q = 0; q < n; ++q)
            if (q != p) moved += theta[q] * force[q];
        m.y[p] += moved;
    }
    pass<points, false>(m, force);
}
template <int points>
void pass_of(TwoPointStream& m, const double* force) {
    end_step<points>(m, m.summed_again, force);
}

// The forces of a step, of one contact and a thread. False: it did not converge.
template <bool barrier, bool thread, bool in_series>
HWY_INLINE bool solve_one(const TwoPointStream& m, Obstacle& obstacle, double* F) {
    constexpr int c = barrier;  // of the thread among the points
    ContactAndThread& at = *obstacle.one();
    double y_b = barrier ? m.y[0] : 0, y_c = thread ? m.y[c] : 0, u_b = barrier ? m.u[0] : 0,
           u_c = thread ? m.u[c] : 0, F_b, F_c;
    if constexpr (in_series) {
        const Residual& series = *obstacle.series();
        const double *yields = series.yields(0), *pulled = series.pulled();
        if constexpr (barrier) y_b += yields[0], u_b -= pulled[0];
        if constexpr (thread) y_c += yields[c], u_c -= pulled[c];
    }
    const bool converged = at.solve<barrier, thread>(y_b, y_b, u_b, y_c, u_c, F_b, F_c);
    if constexpr (barrier) F[0] = F_b;
    if constexpr (thread) F[c] = F_c;
    if constexpr (in_series) obstacle.series()->step<barrier + thread>(F);
    return converged;
}

template <int points, class Solve>
HWY_INLINE bool rows_of(TwoPointStream& m, Obstacle& obstacle, const Block& out, RowsInHand& r,
                        const Solve& solve) {
    double few[points > 0 ? points : 1];
    const Residual* series = obstacle.series();
    return make_rows(
        points == any_number ? m.points : points, points == any_number ? r.force : few, out, r,
        [&](int k) HWY_ATTR {
            const FusedTap& t = r.taps[k];
            return (t.on_first ? dot(t.on_first, m, Column::y) : 0) +
                   (t.on_second ? dot(t.on_second, m, Column::u) : 0);
        },
        [&] { return series ? series->force(0) : nullptr; }, solve,
        [&](const double* force) HWY_ATTR { end_step<points>(m, two_point_summed_again, force); });
}
template <bool barrier, bool thread, bool in_series>
bool rows_of_one(TwoPointStream& m, Obstacle& at, const Block& out, RowsInHand& r) {
    return rows_of<barrier + thread>(m, at, out, r, [&](double* force) HWY_ATTR {
        if constexpr (barrier || thread) return solve_one<barrier, thread, in_series>(m, at, force);
        else return true;
    });
}
template <int points>
bool rows_of_several(TwoPointStream& m, Obstacle& at, const Block& out, RowsInHand& r) {
    const ReadingsBeforeStep readings{m.y, m.y, m.u};
    return rows_of<points>(m, at, out, r, [&](double* force) { return at.solve(readings, force); });
}

template <bool barrier, bool thread>
TwoPointKernel choose_by_series(bool in_series) {
    if constexpr (barrier || thread)
        if (in_series) return rows_of_one<barrier, thread, true>;
    return rows_of_one<barrier, thread, false>;
}
TwoPointKernel choose_kernel(int points, bool one, bool barrier, bool thread, bool in_series) {
    static constexpr TwoPointKernel several[7] = {rows_of_several<any_number>, rows_of_several<1>,
                                                  rows_of_several<2>,          rows_of_several<3>,
                                                  rows_of_several<4>,          rows_of_several<5>,
                                                  rows_of_several<any_number>};
    if (!one) return several[points <= 5 ? points : 6];
    return barrier ? (thread ? choose_by_series<true, true>(in_series)
                             : choose_by_series<true, false>(in_series))
                   : (thread ? choose_by_series<false, true>(in_series)
                             : choose_by_series<false, false>(in_series));
}

TwoPointPass choose_pass(int points) {
    static constexpr TwoPointPass table[7] = {pass_of<0>,         pass_of<1>, pass_of<2>,
                                              pass_of<3>,         pass_of<4>, pass_of<5>,
                                              pass_of<any_number>};
    return table[points <= 5 ? points : 6];
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

TwoPointKernel two_point_kernel(int points, const Obstacle& at) {
    const ContactAndThread* one = at.one();
    return HWY_DYNAMIC_DISPATCH(choose_kernel)(points, one, one && one->contact, one && one->thread,
                                               at.has_series());
}
TwoPointPass two_point_pass(int points) { return HWY_DYNAMIC_DISPATCH(choose_pass)(points); }
TwoPointDot two_point_dot() { return HWY_DYNAMIC_DISPATCH(choose_dot)(); }
double modal_dot(const AlignedVector& w, const AlignedVector& x) {
    return HWY_DYNAMIC_DISPATCH(plain_dot)(w.data(), x.data(), static_cast<int>(x.size()));
}
}  // namespace jvari
#endif
