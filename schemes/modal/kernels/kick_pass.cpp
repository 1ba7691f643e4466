#include "schemes/modal/kernels/kick_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/kick_pass.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "schemes/modal/kernels/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool barrier, bool thread, bool pluck>
void pass(KickPass& m) {
    const D d;
    const V P_b = hn::Set(d, m.P_b), P_c = hn::Set(d, m.P_c), P_e = hn::Set(d, m.P_e);
    double *HWY_RESTRICT q = m.q, *HWY_RESTRICT v = m.v;
    V y_b = hn::Zero(d), y_c = hn::Zero(d);
    for (int i = 0; i < m.size; i += static_cast<int>(hn::Lanes(d))) {
        V g_b{}, g_c{}, v0 = hn::Load(d, v + i);
        if constexpr (pluck) v0 = hn::MulAdd(hn::Load(d, m.g_e + i), P_e, v0);
        if constexpr (thread) v0 = hn::MulAdd(g_c = hn::Load(d, m.g_c + i), P_c, v0);
        if constexpr (barrier) v0 = hn::MulAdd(g_b = hn::Load(d, m.g_b + i), P_b, v0);
        const V q0 = hn::Load(d, q + i);
        const V q1 = hn::MulAdd(hn::Load(d, m.a + i), q0, hn::Mul(hn::Load(d, m.b + i), v0));
        hn::Store(q1, d, q + i);
        hn::Store(hn::MulAdd(hn::Load(d, m.c + i), q0, hn::Mul(hn::Load(d, m.d + i), v0)), d, v + i);
        if constexpr (barrier) y_b = hn::MulAdd(g_b, q1, y_b);
        if constexpr (thread) y_c = hn::MulAdd(g_c, q1, y_c);
    }
    m.y_b = hn::GetLane(hn::SumOfLanes(d, y_b));
    m.y_c = hn::GetLane(hn::SumOfLanes(d, y_c));
}

KickPassFunction choose(bool barrier, bool thread, bool pluck) {
    static constexpr KickPassFunction table[2][2][2] = {
        {{pass<false, false, false>, pass<false, false, true>}, {pass<false, true, false>, pass<false, true, true>}},
        {{pass<true, false, false>, pass<true, false, true>}, {pass<true, true, false>, pass<true, true, true>}}};
    return table[barrier][thread][pluck];
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose);
KickPassFunction kick_pass(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose)(barrier, thread, pluck);
}
}  // namespace jvari
#endif
