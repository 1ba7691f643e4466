// The pass over the modes of modal_two_point_kernel.hpp, and the sums over lanes that end it.
// Compiled once per instruction set by Highway.
#if defined(JVARI_MODAL_TWO_POINT_PASS) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_MODAL_TWO_POINT_PASS
#undef JVARI_MODAL_TWO_POINT_PASS
#else
#define JVARI_MODAL_TWO_POINT_PASS
#endif

#include <hwy/highway.h>

#include "schemes/modal/kernels/modal_two_point_kernel.hpp"
#include "schemes/modal/kernels/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Column = TwoPointColumn;

HWY_INLINE double* column(const TwoPointStream& m, Column of, std::ptrdiff_t mode) {
    return m.stream + two_point_at(of, mode);
}

// dot() with a column of the modes.
HWY_INLINE double dot(const double* HWY_RESTRICT w, const TwoPointStream& m, Column x) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    V even = hn::Zero(d), odd = hn::Zero(d);
    for (int i = 0; i < m.size; i += 2 * N) {
        even = hn::MulAdd(hn::Load(d, w + i), hn::Load(d, column(m, x, i)), even);
        odd = hn::MulAdd(hn::Load(d, w + i + N), hn::Load(d, column(m, x, i + N)), odd);
    }
    return hn::GetLane(hn::SumOfLanes(d, hn::Add(even, odd)));
}

// One pass: the update and the next dots. Presence of contact, thread and pluck is a template
// argument: an absent part costs nothing. Two accumulators per dot hide the latency of adding.
template <bool barrier, bool thread, bool pluck, bool dots_of_y = true>
HWY_INLINE void pass(TwoPointStream& m, double F_b, double F_c, double F_e) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    const V fb = hn::Set(d, F_b), fc = hn::Set(d, F_c), fe = hn::Set(d, F_e);
    double* HWY_RESTRICT stream = m.stream;
    const double* HWY_RESTRICT ge = m.g_e;
    V yb[2], yc[2], ub[2], uc[2];
    for (int k = 0; k < 2; ++k) yb[k] = yc[k] = ub[k] = uc[k] = hn::Zero(d);
    const auto at = [&](int j, int k) HWY_ATTR __attribute__((always_inline)) {
        double* HWY_RESTRICT line =
            stream + (N == two_point_line ? j * two_point_columns : two_point_at(Column::y, j));
        const auto of = [&](Column q) HWY_ATTR __attribute__((always_inline)) {
            return line + static_cast<int>(q) * two_point_line;
        };
        const V y0 = hn::Load(d, of(Column::y)), u0 = hn::Load(d, of(Column::u));
        V forced = hn::Zero(d), g_b{}, g_c{};
        if constexpr (pluck) forced = hn::Mul(hn::Load(d, ge + j), fe);
        if constexpr (thread) {
            g_c = in_register(hn::Load(d, of(Column::g_c)));
            forced = pluck ? hn::MulAdd(g_c, fc, forced) : hn::Mul(g_c, fc);
        }
        if constexpr (barrier) {
            g_b = in_register(hn::Load(d, of(Column::g_b)));
            forced = hn::MulAdd(g_b, fb, forced);
        }
        const V s = hn::Add(u0, forced);  // (41)
        const V y1 = hn::Add(y0, s);      // (40)
        const V u1 =
            hn::NegMulAdd(hn::Load(d, of(Column::c)), y1,
                          hn::NegMulAdd(hn::Load(d, of(Column::loss)), s, hn::Add(s, forced)));
        hn::Store(u1, d, of(Column::u));
        hn::Store(y1, d, of(Column::y));
        if constexpr (barrier) {
            if constexpr (dots_of_y) yb[k] = hn::MulAdd(g_b, y1, yb[k]);
            ub[k] = hn::MulAdd(g_b, u1, ub[k]);
        }
        if constexpr (thread) {
            if constexpr (dots_of_y) yc[k] = hn::MulAdd(g_c, y1, yc[k]);
            uc[k] = hn::MulAdd(g_c, u1, uc[k]);
        }
    };
    int i = 0;
    for (; i + N < m.modes; i += 2 * N) {
        at(i, 0);
        at(i + N, 1);
    }
    if (i < m.modes) at(i, 0);
    const auto both = [](const V(&v)[2]) { return hn::Add(v[0], v[1]); };
    alignas(64) double sum[4];
    sums(both(yb), both(ub), both(yc), both(uc), sum);
    if constexpr (dots_of_y) m.y_b = sum[0], m.y_c = sum[2];
    m.u_b = sum[1];
    m.u_c = sum[3];
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();
#endif
