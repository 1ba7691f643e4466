// Pass of the modal two-point string, and its fused rows (van Walstijn et al. 2016, eqs 41-48);
// Highway compiles both once per instruction set. The numbers of contacts and threads up to five,
// and the series compliance, are template arguments, so that absent parts cost nothing.
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

// Pass for a step, which sums g_z.y only now and then.
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

// Forces in a step with few contacts and a thread. False: no convergence.
template <int contacts, bool thread, bool in_series>
HWY_INLINE bool solve_few(const TwoPointStream& m, Obstacle& obstacle, double* force) {
    constexpr int points = contacts + thread;
    if constexpr (in_series) {
        Residual& series = *obstacle.series();
        double y[points], u[points];
        for (int p = 0; p < points; ++p) {
            y[p] = m.y[p] + series.yields(0)[p];
            u[p] = m.u[p] - series.pulled()[p];
        }
        const bool converged = obstacle.solve_few<contacts, thread>(y, u, force);
        series.step<points>(force);
        return converged;
    } else {
        return points == 0 || obstacle.solve_few<contacts, thread>(m.y, m.u, force);
    }
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
template <int contacts, bool thread, bool in_series>
bool rows_of_few(TwoPointStream& m, Obstacle& at, const Block& out, RowsInHand& r) {
    return rows_of<contacts + thread>(m, at, out, r, [&](double* force) HWY_ATTR {
        return solve_few<contacts, thread, in_series>(m, at, force);
    });
}
template <int points>
bool rows_of_several(TwoPointStream& m, Obstacle& at, const Block& out, RowsInHand& r) {
    const ReadingsBeforeStep readings{m.y, m.y, m.u};
    return rows_of<points>(m, at, out, r, [&](double* force) { return at.solve(readings, force); });
}

TwoPointKernel choose_kernel(int points, int contacts, bool few, bool in_series) {
    static constexpr TwoPointKernel several[7] = {rows_of_several<any_number>, rows_of_several<1>,
                                                  rows_of_several<2>,          rows_of_several<3>,
                                                  rows_of_several<4>,          rows_of_several<5>,
                                                  rows_of_several<any_number>};
    if (!few) return several[points <= 5 ? points : 6];
        // [contacts][series]
#define JVARI_BY_SERIES(contacts, thread) \
    { rows_of_few<contacts, thread, false>, rows_of_few<contacts, thread, true> }
    static constexpr TwoPointKernel without[6][2] = {{rows_of_few<0, false, false>, nullptr},
                                                     JVARI_BY_SERIES(1, false),
                                                     JVARI_BY_SERIES(2, false),
                                                     JVARI_BY_SERIES(3, false),
                                                     JVARI_BY_SERIES(4, false),
                                                     JVARI_BY_SERIES(5, false)};
    static constexpr TwoPointKernel with[5][2] = {
        JVARI_BY_SERIES(0, true), JVARI_BY_SERIES(1, true), JVARI_BY_SERIES(2, true),
        JVARI_BY_SERIES(3, true), JVARI_BY_SERIES(4, true)};
#undef JVARI_BY_SERIES
    return points > contacts ? with[contacts][in_series] : without[contacts][in_series];
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
    return HWY_DYNAMIC_DISPATCH(choose_kernel)(points, at.contacts(), at.few(), at.has_series());
}
TwoPointPass two_point_pass(int points) { return HWY_DYNAMIC_DISPATCH(choose_pass)(points); }
TwoPointDot two_point_dot() { return HWY_DYNAMIC_DISPATCH(choose_dot)(); }
double modal_dot(const AlignedVector& w, const AlignedVector& x) {
    return HWY_DYNAMIC_DISPATCH(plain_dot)(w.data(), x.data(), static_cast<int>(x.size()));
}
}  // namespace jvari
#endif
