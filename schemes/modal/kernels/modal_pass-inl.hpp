// The passes of modal_pass.hpp in the vectors of the instruction set that is being compiled: included once for each, after Highway.
// Presence of contact, thread and pluck is a template argument: an absent part costs nothing. Two accumulators per dot hide the latency of
// adding.
#if defined(JVARI_MODAL_PASS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_MODAL_PASS_INL
#undef JVARI_MODAL_PASS_INL
#else
#define JVARI_MODAL_PASS_INL
#endif

#include "schemes/modal/kernels/modal_pass.hpp"
#include "schemes/modal/kernels/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool barrier, bool thread, bool pluck>
HWY_INLINE void pass(ModalPass& m) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    const V F_b = hn::Set(d, m.F_b), F_c = hn::Set(d, m.F_c), F_e = hn::Set(d, m.F_e);
    double *HWY_RESTRICT x = m.x, *HWY_RESTRICT v = m.v;
    V x_b[2], v_b[2], x_c[2], v_c[2];
    for (int k = 0; k < 2; ++k) x_b[k] = v_b[k] = x_c[k] = v_c[k] = hn::Zero(d);
    const auto update = [&](int j, int k) HWY_ATTR __attribute__((always_inline)) {  // else the sums go through memory
        V force = hn::Zero(d), next;
        if constexpr (pluck) force = hn::Mul(hn::Load(d, m.e_e + j), F_e);
        if constexpr (thread) force = hn::MulAdd(hn::Load(d, m.e_c + j), F_c, force);
        if constexpr (barrier) force = hn::MulAdd(hn::Load(d, m.e_b + j), F_b, force);
        V xj = hn::Load(d, x + j), vj = hn::Load(d, v + j);
        const V s = hn::Add(vj, force);
        vj = next = hn::Sub(hn::Mul(hn::Load(d, m.p + j), s), hn::MulAdd(hn::Load(d, m.r + j), xj, vj));
        xj = hn::Add(xj, s);
        hn::Store(xj, d, x + j);
        hn::Store(vj, d, v + j);
        if constexpr (barrier) {
            const V g = hn::Load(d, m.g_b + j);
            x_b[k] = hn::MulAdd(g, xj, x_b[k]);
            v_b[k] = hn::MulAdd(g, next, v_b[k]);
        }
        if constexpr (thread) {
            const V g = hn::Load(d, m.g_c + j);
            x_c[k] = hn::MulAdd(g, xj, x_c[k]);
            v_c[k] = hn::MulAdd(g, next, v_c[k]);
        }
    };
    int i = 0;
    for (; i + 2 * N <= m.size; i += 2 * N) {
        update(i, 0);
        update(i + N, 1);
    }
    if (i < m.size) update(i, 0);
    const auto sum = [d](const V(&a)[2]) { return hn::GetLane(hn::SumOfLanes(d, hn::Add(a[0], a[1]))); };
    if constexpr (barrier) {
        m.x_b = sum(x_b);
        m.v_b = sum(v_b);
    }
    if constexpr (thread) {
        m.x_c = sum(x_c);
        m.v_c = sum(v_c);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#endif
