// The fused step of the modal two-point scheme (van Walstijn et al. 2016, eqs 41-48), compiled once per instruction set by Highway.
// Presence of contact, thread and pluck is a template argument: an absent part costs nothing. So is what stands in series with the points.
#include "schemes/modal/kernels/modal_two_point_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/modal_two_point_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "schemes/modal/kernels/modal_two_point_pass-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Supplied and dissipated energy of the step that is about to be made (51, 52), in the scaled modes.
template <bool barrier, bool thread, bool pluck>
HWY_INLINE void ledger(TwoPoint& m, double F_b, double F_c, double F_e, double s_c) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    V lost = hn::Zero(d), given = hn::Zero(d);
    for (int j = 0; j < m.size; j += N) {
        V s = hn::Load(d, column(m, Column::u, j));
        if constexpr (pluck) s = hn::MulAdd(hn::Load(d, m.g_e + j), hn::Set(d, F_e), s);
        if constexpr (thread) s = hn::MulAdd(hn::Load(d, column(m, Column::g_c, j)), hn::Set(d, F_c), s);
        if constexpr (barrier) s = hn::MulAdd(hn::Load(d, column(m, Column::g_b, j)), hn::Set(d, F_b), s);
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
    ResidualPair& z = m.series.points;
    double F_b = 0, F_c = 0, F_e = 0, y_b = m.y_b, y_c = m.y_c, u_b = m.u_b, u_c = m.u_c, v_c = 0, change = 0;
    if constexpr (pluck) {
        const long n = m.step - m.pluck_first;
        F_e = m.pluck[n];
        if constexpr (barrier) u_b += m.theta_be * F_e;
        if constexpr (thread) u_c += m.theta_ce * F_e;
        if constexpr (matched) {
            change = m.series.pluck[n + 1] - m.series.pluck[n];
            y_b += z.C_be * m.series.pluck[n];
            y_c += z.C_ce * m.series.pluck[n];
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
        if constexpr (kind == ContactKind::linear) x = solve_linear_contact(m.barrier.k, eta, b, m.theta);
        else x = solve_power_contact(m.barrier, eta, b, m.theta);
        F_b = x.force;
        note<kind>(m, x, eta);
    }
    if constexpr (thread) {
        F_c = barrier ? v_c - m.beta_c * F_b : v_c;  // (46)
        m.impulse_c += F_c;
    }
    if constexpr (probe) {
        ledger<barrier, thread, pluck>(m, F_b, F_c, F_e, u_c + m.theta_bc * F_b + m.theta_cc * F_c);  // s_c by (44)
        if constexpr (matched) m.dissipated += z.lost(F_b, F_c);
        if constexpr (matched && pluck) m.supplied -= (F_b * z.C_be + F_c * z.C_ce) * change;
    }
    if constexpr (matched) z.take<barrier, thread>(F_b, F_c);
    take(m, pass<barrier, thread, pluck>(m, F_b, F_c, F_e));
    ++m.step;
}

template <ContactKind kind, bool thread, bool probe, Compliance compliance>
HWY_INLINE void steps(TwoPoint& m, long count) {
    while (count > 0) {
        const long into = m.step - m.pluck_first;  // the pluck acts for pluck_steps from pluck_first
        const bool plucking = into >= 0 && into < m.pluck_steps;
        const long until_change = plucking ? m.pluck_steps - into : into < 0 && m.pluck_steps > 0 ? -into : count;
        const long n = until_change < count ? until_change : count;
        if (plucking)
            for (long i = 0; i < n; ++i) step<kind, thread, true, probe, compliance>(m);
        else
            for (long i = 0; i < n; ++i) step<kind, thread, false, probe, compliance>(m);
        count -= n;
    }
}

template <ContactKind kind, bool thread, bool probe, Compliance compliance>
HWY_INLINE bool steps_of_row(TwoPoint& m, const Block& out) {  // false: the caller wants no more
    long left = m.steps_per_row;
    for (; left > steps_between_questions; left -= steps_between_questions) {
        steps<kind, thread, probe, compliance>(m, steps_between_questions);
        if (out.stopped()) return false;
    }
    steps<kind, thread, probe, compliance>(m, left);
    return true;
}

double pluck_now(const TwoPoint& m) {
    const long into = m.step - m.pluck_first;
    return into >= 0 && into <= m.pluck_steps && m.series.pluck ? m.series.pluck[into] : 0;
}

// Stored energy (49): sum (q^2 + A y^2)/xi with q = J u/2 + A y, in the scaled modes. While a pluck acts, what its force alone and together
// with others stores in C is left out, and its work counted to match.
template <ContactKind kind, bool thread, Compliance compliance>
double stored(const TwoPoint& m) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    const V half = hn::Set(d, 0.5), quarter = hn::Set(d, 0.25);
    V by_q = hn::Zero(d), by_y = hn::Zero(d);
    for (int j = 0; j < m.size; j += N) {
        const V y = hn::Load(d, column(m, Column::y, j)),
                stiff = hn::Mul(quarter, hn::Mul(hn::Load(d, column(m, Column::c, j)), y));  // A y/J
        const V q = hn::MulAdd(half, hn::Load(d, column(m, Column::u, j)), stiff);           // q/J
        by_q = hn::MulAdd(hn::Mul(hn::Load(d, m.J + j), q), q, by_q);
        by_y = hn::MulAdd(stiff, y, by_y);
    }
    double H = hn::GetLane(hn::SumOfLanes(d, hn::Add(by_q, by_y)));
    double y_b = m.y_b, y_c = m.y_c;
    if constexpr (compliance == Compliance::matched) {
        const ResidualPair& z = m.series.points;
        y_b += z.D_b + z.C_be * pluck_now(m);
        y_c += z.D_c + z.C_ce * pluck_now(m);
        H += z.stored();
    }
    if constexpr (kind != ContactKind::none) H += m.barrier.potential(m.h_b - y_b);
    if constexpr (thread) H += 0.5 * m.k_c * (m.h_c - y_c) * (m.h_c - y_c);
    return H;
}

HWY_INLINE double value(const TwoPoint& m, const TwoPointTap& tap) {
    const double steps = m.steps_per_row;
    switch (tap.from) {
        case TwoPointTap::From::modes: return dot(tap.on_y, m, Column::y);
        case TwoPointTap::From::modes_and_increment: return dot(tap.on_y, m, Column::y) + dot(tap.on_u, m, Column::u);
        case TwoPointTap::From::bridge: return m.impulse_b / steps;
        case TwoPointTap::From::thread: return m.impulse_c / steps;
        case TwoPointTap::From::driving: return -(m.impulse_b + m.impulse_c) / steps;
    }
    return 0;
}

template <ContactKind kind, bool thread, Compliance compliance>
HWY_INLINE void write(TwoPoint& m, const Block& out, int row) {
    double P_b = 0, P_c = 0, F_e = 0;
    if constexpr (compliance == Compliance::matched) {
        P_b = m.series.points.P_b();
        P_c = m.series.points.P_c();
        if (m.series.pluck) F_e = pluck_now(m);
    }
    for (int k = 0; k < out.taps; ++k) {
        const TwoPointTap& tap = m.taps[k];
        double x = value(m, tap);
        if constexpr (compliance == Compliance::matched)
            if (tap.from == TwoPointTap::From::modes) x += tap.on_force[0] * P_b + tap.on_force[1] * P_c + tap.on_force[2] * F_e;
        out.tap[k * out.stride + row] = x;
    }
    m.impulse_b = m.impulse_c = 0;
    if (!out.energy) return;
    write_energy(out, row, stored<kind, thread, compliance>(m), m.supplied, m.dissipated);
    m.supplied = m.dissipated = 0;
}

template <ContactKind kind, bool thread, Compliance compliance>
Status advance(TwoPoint& m, const Block& out) {
    for (int row = 0; row < out.rows && m.status.outcome == Outcome::ok; ++row) {
        write<kind, thread, compliance>(m, out, row);
        const bool on =
            out.energy ? steps_of_row<kind, thread, true, compliance>(m, out) : steps_of_row<kind, thread, false, compliance>(m, out);
        if (!on) return {};
    }
    return m.status;
}

template <Compliance compliance>
TwoPointAdvance choose_for(ContactKind kind, bool thread) {
    using enum ContactKind;
    switch (kind) {
        case none: return thread ? advance<none, true, compliance> : advance<none, false, compliance>;
        case linear: return thread ? advance<linear, true, compliance> : advance<linear, false, compliance>;
        case power: return thread ? advance<power, true, compliance> : advance<power, false, compliance>;
    }
    return {};
}
TwoPointAdvance choose(ContactKind kind, bool thread, Compliance compliance) {
    return compliance == Compliance::own ? choose_for<Compliance::own>(kind, thread) : choose_for<Compliance::matched>(kind, thread);
}

double plain_dot(const double* w, const double* x, int size) {
    return dot(w, x, size);
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose);
HWY_EXPORT(plain_dot);

TwoPointAdvance two_point_kernel(ContactKind kind, bool thread, Compliance compliance) {
    return HWY_DYNAMIC_DISPATCH(choose)(kind, thread, compliance);
}
double two_point_dot(const double* w, const double* x, int size) {
    return HWY_DYNAMIC_DISPATCH(plain_dot)(w, x, size);
}
}  // namespace jvari
#endif
