// Presence of contact, thread and pluck is a template argument: an absent part costs nothing. Two accumulators per dot hide the latency of
// adding.
#include "schemes/modal/modal_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/modal_pass.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

struct TwoPointForm {
    static constexpr bool reads_x = true;
    static HWY_INLINE void update(V& x, V& v, V p, V r, V force, V& next) {
        const V s = hn::Add(v, force);
        v = next = hn::Sub(hn::Mul(p, s), hn::MulAdd(r, x, v));
        x = hn::Add(x, s);
    }
};
struct ThreePointForm {
    static constexpr bool reads_x = true;
    static HWY_INLINE void update(V& x, V& v, V p, V r, V force, V& next) {
        v = hn::Add(hn::NegMulAdd(r, x, hn::NegMulAdd(p, v, v)), force);
        x = hn::Add(x, v);
        next = hn::NegMulAdd(r, x, hn::NegMulAdd(p, v, hn::Add(v, v)));
    }
};

struct AheadForm {
    static constexpr bool reads_x = false;
    static HWY_INLINE void update(V& x, V& v, V p, V r, V force, V& next) {
        v = hn::Add(hn::NegMulAdd(r, x, hn::NegMulAdd(p, v, v)), force);
        x = hn::Add(x, v);
        next = hn::Add(x, hn::NegMulAdd(r, x, hn::NegMulAdd(p, v, v)));
    }
};

template <class Form, bool barrier, bool thread, bool pluck>
void pass(ModalPass& m) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    const V F_b = hn::Set(d, m.F_b), F_c = hn::Set(d, m.F_c), F_e = hn::Set(d, m.F_e);
    double *HWY_RESTRICT x = m.x, *HWY_RESTRICT v = m.v;
    V x_b[2], v_b[2], x_c[2], v_c[2];
    for (int k = 0; k < 2; ++k) x_b[k] = v_b[k] = x_c[k] = v_c[k] = hn::Zero(d);
    for (int i = 0; i < m.size; i += 2 * N)
        for (int k = 0; k < 2; ++k) {
            const int j = i + k * N;
            V force = hn::Zero(d), next;
            if constexpr (pluck) force = hn::Mul(hn::LoadU(d, m.e_e + j), F_e);
            if constexpr (thread) force = hn::MulAdd(hn::LoadU(d, m.e_c + j), F_c, force);
            if constexpr (barrier) force = hn::MulAdd(hn::LoadU(d, m.e_b + j), F_b, force);
            V xj = hn::LoadU(d, x + j), vj = hn::LoadU(d, v + j);
            Form::update(xj, vj, hn::LoadU(d, m.p + j), hn::LoadU(d, m.r + j), force, next);
            hn::StoreU(xj, d, x + j);
            hn::StoreU(vj, d, v + j);
            if constexpr (barrier) {
                const V g = hn::LoadU(d, m.g_b + j);
                if constexpr (Form::reads_x) x_b[k] = hn::MulAdd(g, xj, x_b[k]);
                v_b[k] = hn::MulAdd(g, next, v_b[k]);
            }
            if constexpr (thread) {
                const V g = hn::LoadU(d, m.g_c + j);
                if constexpr (Form::reads_x) x_c[k] = hn::MulAdd(g, xj, x_c[k]);
                v_c[k] = hn::MulAdd(g, next, v_c[k]);
            }
        }
    const auto sum = [d](const V(&a)[2]) { return hn::GetLane(hn::SumOfLanes(d, hn::Add(a[0], a[1]))); };
    if constexpr (barrier) {
        if constexpr (Form::reads_x) m.x_b = sum(x_b);
        m.v_b = sum(v_b);
    }
    if constexpr (thread) {
        if constexpr (Form::reads_x) m.x_c = sum(x_c);
        m.v_c = sum(v_c);
    }
}

template <class Form>
ModalPassFunction choose(bool barrier, bool thread, bool pluck) {
    static constexpr ModalPassFunction table[2][2][2] = {
        {{pass<Form, false, false, false>, pass<Form, false, false, true>},
         {pass<Form, false, true, false>, pass<Form, false, true, true>}},
        {{pass<Form, true, false, false>, pass<Form, true, false, true>}, {pass<Form, true, true, false>, pass<Form, true, true, true>}}};
    return table[barrier][thread][pluck];
}
ModalPassFunction choose_two_point(bool barrier, bool thread, bool pluck) {
    return choose<TwoPointForm>(barrier, thread, pluck);
}
ModalPassFunction choose_three_point(bool barrier, bool thread, bool pluck) {
    return choose<ThreePointForm>(barrier, thread, pluck);
}
ModalPassFunction choose_ahead(bool barrier, bool thread, bool pluck) {
    return choose<AheadForm>(barrier, thread, pluck);
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose_two_point);
HWY_EXPORT(choose_three_point);
HWY_EXPORT(choose_ahead);

ModalPassFunction two_point_pass(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_two_point)(barrier, thread, pluck);
}
ModalPassFunction three_point_pass(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_three_point)(barrier, thread, pluck);
}
ModalPassFunction three_point_pass_ahead(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_ahead)(barrier, thread, pluck);
}
}  // namespace jvari
#endif
