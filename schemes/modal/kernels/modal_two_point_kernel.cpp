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

// Supplied and dissipated energy of the step that is about to be made (51, 52), in the scaled
// modes.
template <bool barrier, bool thread, bool pluck>
HWY_INLINE void ledger(TwoPoint& m, double F_b, double F_c, double F_e, double s_c) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    V lost = hn::Zero(d), given = hn::Zero(d);
    for (int j = 0; j < m.size; j += N) {
        V s = hn::Load(d, column(m, Column::u, j));
        if constexpr (pluck) s = hn::MulAdd(hn::Load(d, m.g_e + j), hn::Set(d, F_e), s);
        if constexpr (thread)
            s = hn::MulAdd(hn::Load(d, column(m, Column::g_c, j)), hn::Set(d, F_c), s);
        if constexpr (barrier)
            s = hn::MulAdd(hn::Load(d, column(m, Column::g_b, j)), hn::Set(d, F_b), s);
        lost = hn::MulAdd(hn::Load(d, column(m, Column::loss, j)), hn::Mul(s, s), lost);
        if constexpr (pluck) given = hn::MulAdd(hn::Load(d, m.g_e + j), s, given);
    }
    m.dissipated += 0.5 * hn::GetLane(hn::SumOfLanes(d, lost));  // B/J = loss/2
    if constexpr (thread) m.dissipated += m.r_c / m.dt * s_c * s_c;
    if constexpr (pluck) m.supplied += F_e * hn::GetLane(hn::SumOfLanes(d, given));
}

template <ContactKind kind, bool thread, bool pluck, bool probe, Compliance compliance>
HWY_INLINE void step(TwoPoint& m) {
    constexpr bool barrier = kind != ContactKind::none, matched = compliance == Compliance::matched;
    ResidualPair& z = m.series;
    double F_b = 0, F_c = 0, F_e = 0, y_b = m.y_b, y_c = m.y_c, u_b = m.u_b, u_c = m.u_c, v_c = 0,
           change = 0;
    if constexpr (pluck) {
        const long n = m.step - m.pluck_first;
        F_e = m.pluck[n];
        if constexpr (barrier) u_b += m.theta_be * F_e;
        if constexpr (thread) u_c += m.theta_ce * F_e;
        if constexpr (matched) {
            change = m.pluck_now[n + 1] - m.pluck_now[n];
            y_b += z.C_be * m.pluck_now[n];
            y_c += z.C_ce * m.pluck_now[n];
            u_b += z.C_be * change;
            u_c += z.C_ce * change;
        }
    }
    if constexpr (matched && barrier) y_b += z.D_b, u_b -= z.H_b;
    if constexpr (matched && thread) y_c += z.D_c, u_c -= z.H_c;
    if constexpr (thread) v_c = (m.k_c * (m.h_c - y_c) - m.phi_c * u_c) * m.inverse_c;  // (47)
    if constexpr (barrier) {
        const double eta = m.h_b - y_b, b = thread ? -u_b - m.theta_bc * v_c : -u_b;  // (48)
        ContactSolution x;
        if constexpr (kind == ContactKind::linear)
            x = solve_linear_contact(m.barrier.k, eta, b, m.theta);
        else x = solve_power_contact(m.barrier, eta, b, m.theta);
        F_b = x.force;
        m.range.note(F_b);
        m.depth = eta > m.depth ? eta : m.depth;
        m.impulse_b += F_b;
        if constexpr (kind == ContactKind::power) {
            m.iterations += x.iterations;
            m.iterations_most = x.iterations > m.iterations_most ? x.iterations : m.iterations_most;
            if (!x.converged && m.status.outcome == Outcome::ok)
                m.status = {Outcome::not_converged, m.step};
        }
    }
    if constexpr (thread) {
        F_c = barrier ? v_c - m.beta_c * F_b : v_c;  // (46)
        m.impulse_c += F_c;
    }
    if constexpr (probe) {
        // s_c by (44)
        ledger<barrier, thread, pluck>(m, F_b, F_c, F_e, u_c + m.theta_bc * F_b + m.theta_cc * F_c);
        if constexpr (matched) m.dissipated += z.lost(F_b, F_c);
        if constexpr (matched && pluck) m.supplied -= (F_b * z.C_be + F_c * z.C_ce) * change;
    }
    if constexpr (matched) z.take<barrier, thread>(F_b, F_c);
    if (m.step % two_point_summed_again == 0) pass<barrier, thread, pluck>(m, F_b, F_c, F_e);
    else {
        if constexpr (barrier)
            m.y_b += m.u_b + m.own_bb * F_b + (thread ? m.own_bc * F_c : 0) +
                     (pluck ? m.theta_be * F_e : 0);
        if constexpr (thread)
            m.y_c += m.u_c + m.own_cc * F_c + (barrier ? m.own_bc * F_b : 0) +
                     (pluck ? m.theta_ce * F_e : 0);
        pass<barrier, thread, pluck, false>(m, F_b, F_c, F_e);
    }
    ++m.step;
}

template <ContactKind kind, bool thread, bool probe, Compliance compliance>
HWY_INLINE void steps(TwoPoint& m, long count) {
    while (count > 0) {
        // the pluck acts for pluck_steps from pluck_first
        const long into = m.step - m.pluck_first;
        const bool plucking = into >= 0 && into < m.pluck_steps;
        const long until_change = plucking                        ? m.pluck_steps - into
                                  : into < 0 && m.pluck_steps > 0 ? -into
                                                                  : count;
        const long n = until_change < count ? until_change : count;
        if (plucking)
            for (long i = 0; i < n; ++i) step<kind, thread, true, probe, compliance>(m);
        else
            for (long i = 0; i < n; ++i) step<kind, thread, false, probe, compliance>(m);
        count -= n;
    }
}

HWY_INLINE void write(TwoPoint& m, const Block& out, int row, bool matched) {
    const double steps = m.steps_per_row, F_b = m.impulse_b / steps, F_c = m.impulse_c / steps,
                 P_b = m.series.P_b(), P_c = m.series.P_c();
    const long n = m.step - m.pluck_first;
    const double F_e = m.pluck_now && n >= 0 && n <= m.pluck_steps ? m.pluck_now[n] : 0;
    for (int k = 0; k < out.taps; ++k) {
        const TwoPointTap& t = m.taps[k];
        double x = t.on_b * F_b + t.on_c * F_c;
        if (t.on_y) x += dot(t.on_y, m, Column::y);
        if (t.on_u) x += dot(t.on_u, m, Column::u);
        if (matched) x += t.on_P_b * P_b + t.on_P_c * P_c + t.on_e * F_e;
        out.tap[k * out.stride + row] = x;
    }
    m.impulse_b = m.impulse_c = 0;
}

template <ContactKind kind, bool thread, Compliance compliance>
bool row_of(TwoPoint& m, const Block& out, int row) {
    write(m, out, row, compliance == Compliance::matched);
    for (long left = m.steps_per_row; left > 0; left -= steps_between_questions) {
        const long count = left < steps_between_questions ? left : steps_between_questions;
        if (out.energy) steps<kind, thread, true, compliance>(m, count);
        else steps<kind, thread, false, compliance>(m, count);
        if (left > count && out.stopped()) return false;
    }
    return true;
}

template <Compliance compliance>
TwoPointRow choose_for(ContactKind kind, bool thread) {
    using enum ContactKind;
    switch (kind) {
        case none: return thread ? row_of<none, true, compliance> : row_of<none, false, compliance>;
        case linear:
            return thread ? row_of<linear, true, compliance> : row_of<linear, false, compliance>;
        case power:
            return thread ? row_of<power, true, compliance> : row_of<power, false, compliance>;
    }
    return {};
}
TwoPointRow choose_row(ContactKind kind, bool thread, Compliance compliance) {
    return compliance == Compliance::own ? choose_for<Compliance::own>(kind, thread)
                                         : choose_for<Compliance::matched>(kind, thread);
}

TwoPointPass choose_pass(bool barrier, bool thread, bool pluck) {
    static constexpr TwoPointPass table[2][2][2] = {
        {{pass<false, false, false>, pass<false, false, true>},
         {pass<false, true, false>, pass<false, true, true>}},
        {{pass<true, false, false>, pass<true, false, true>},
         {pass<true, true, false>, pass<true, true, true>}}};
    return table[barrier][thread][pluck];
}

double dot_of_column(const double* w, const TwoPointStream& m, TwoPointColumn x) {
    return dot(w, m, x);
}
double plain_dot(const double* w, const double* x, int size) { return dot(w, x, size); }

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose_row);
HWY_EXPORT(choose_pass);
HWY_EXPORT(dot_of_column);
HWY_EXPORT(plain_dot);

TwoPointRow two_point_row(ContactKind kind, bool thread, Compliance compliance) {
    return HWY_DYNAMIC_DISPATCH(choose_row)(kind, thread, compliance);
}
TwoPointPass two_point_pass(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_pass)(barrier, thread, pluck);
}
double two_point_dot(const double* w, const TwoPointStream& m, TwoPointColumn x) {
    return HWY_DYNAMIC_DISPATCH(dot_of_column)(w, m, x);
}
double modal_dot(const AlignedVector& w, const AlignedVector& x) {
    return HWY_DYNAMIC_DISPATCH(plain_dot)(w.data(), x.data(), static_cast<int>(x.size()));
}
}  // namespace jvari
#endif
