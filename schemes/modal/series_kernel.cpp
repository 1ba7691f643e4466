#include "schemes/modal/series_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/series_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "schemes/modal/modal_pass-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {

template <bool barrier, bool thread>
Status advance(SeriesRows& s, const Block& out) {
    const ModalString& m = *s.string;
    SeriesForce& contact = *s.contact;
    const SeriesPoints points = contact.points;  // no store can change them
    ModalPass pass_of = *s.pass;
    SeriesForce::Moving at = contact.now;
    const double per_row = m.steps_per_row;
    const int steps = m.steps_per_row;
    const bool plucked = !m.g_e.empty();
    double impulse_b = s.impulse_b, impulse_c = s.impulse_c;
    double y_b = s.y_b, y_c = s.y_c, F_b = s.F_b, F_c = s.F_c, F_e = s.F_e;
    Status status;
    for (int row = 0; row < out.rows; ++row) {
        const double mean_b = steps == 1 ? impulse_b : impulse_b / per_row, mean_c = steps == 1 ? impulse_c : impulse_c / per_row;
        for (int k = 0; k < out.taps; ++k) {
            double& value = out.tap[k * out.stride + row];
            switch (m.taps[k].quantity) {
                case Quantity::bridge_force: value = mean_b; break;
                case Quantity::thread_force: value = mean_c; break;
                case Quantity::driving_force: value = -(mean_b + mean_c); break;
                default: value = dot(m.taps[k].weights.data(), s.q, pass_of.size) + contact.C.on_tap(k, at.force.b, at.force.c, at.F_e);
            }
        }
        const double weight = s.step == 0 ? 1 : 0.5;  // the forces of the first step have their half weight already
        impulse_b = weight * F_b;
        impulse_c = weight * F_c;
        for (int k = 0; k < steps; ++k) {
            pass_of.F_b = F_b;
            pass_of.F_c = F_c;
            pass_of.F_e = F_e;
            y_b = pass_of.v_b + s.theta_bb * F_b + s.theta_bc * F_c + s.theta_be * F_e;
            y_c = pass_of.v_c + s.theta_bc * F_b + s.theta_cc * F_c + s.theta_ce * F_e;
            if (F_e != 0) pass<AheadForm, barrier, thread, true>(pass_of);
            else pass<AheadForm, barrier, thread, false>(pass_of);
            ++s.step;
            F_e = plucked ? m.pluck_at(s.step) : 0;
            at.act(points, contact.C, y_b, y_c, F_e, false);
            F_b = at.force.b;
            F_c = at.force.c;
            if (out.stopped(k, steps_between_questions)) return {};
            if (k + 1 == steps) break;
            impulse_b += F_b;
            impulse_c += F_c;
        }
        impulse_b += 0.5 * F_b;
        impulse_c += 0.5 * F_c;
        if (!(std::abs(y_b + y_c) < modal_overflow)) {
            status = {Outcome::diverged, s.step - 1};
            break;
        }
    }
    *s.pass = pass_of;
    contact.now = at;
    s.impulse_b = impulse_b;
    s.impulse_c = impulse_c;
    s.y_b = y_b;
    s.y_c = y_c;
    s.F_b = F_b;
    s.F_c = F_c;
    s.F_e = F_e;
    return status;
}

SeriesAdvance choose_series(bool barrier, bool thread) {
    static constexpr SeriesAdvance table[2][2] = {{advance<false, false>, advance<false, true>},
                                                  {advance<true, false>, advance<true, true>}};
    return table[barrier][thread];
}
double plain_series_dot(const double* w, const double* x, int size) {
    return dot(w, x, size);
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose_series);
HWY_EXPORT(plain_series_dot);

SeriesAdvance series_advance(bool barrier, bool thread) {
    return HWY_DYNAMIC_DISPATCH(choose_series)(barrier, thread);
}
double series_dot(const ModalArray& w, const ModalArray& x) {
    return HWY_DYNAMIC_DISPATCH(plain_series_dot)(w.data(), x.data(), static_cast<int>(w.size()));
}
}  // namespace jvari
#endif
