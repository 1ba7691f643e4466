#include "schemes/modal/kernels/series_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/series_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "schemes/modal/kernels/modal_pass-inl.hpp"

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
    const SeriesRows::Compliances theta = *s.theta;
    SeriesRows::State now = *s.state;
    Status status;
    for (int row = 0; row < out.rows; ++row) {
        const double mean_b = steps == 1 ? now.impulse_b : now.impulse_b / per_row,
                     mean_c = steps == 1 ? now.impulse_c : now.impulse_c / per_row;
        for (int k = 0; k < out.taps; ++k) {
            double& value = out.tap[k * out.stride + row];
            switch (m.taps[k].quantity) {
                case Quantity::bridge_force: value = mean_b; break;
                case Quantity::thread_force: value = mean_c; break;
                case Quantity::driving_force: value = -(mean_b + mean_c); break;
                default: value = dot(m.taps[k].weights.data(), s.q, pass_of.size) + contact.C.on_tap(k, at.force.b, at.force.c, at.F_e);
            }
        }
        const double weight = now.step == 0 ? 1 : 0.5;  // the forces of the first step have their half weight already
        now.impulse_b = weight * now.F_b;
        now.impulse_c = weight * now.F_c;
        for (int k = 0; k < steps; ++k) {
            pass_of.F_b = now.F_b;
            pass_of.F_c = now.F_c;
            pass_of.F_e = now.F_e;
            now.y_b = pass_of.v_b + theta.bb * now.F_b + theta.bc * now.F_c + theta.be * now.F_e;
            now.y_c = pass_of.v_c + theta.bc * now.F_b + theta.cc * now.F_c + theta.ce * now.F_e;
            if (now.F_e != 0) pass<AheadForm, barrier, thread, true>(pass_of);
            else pass<AheadForm, barrier, thread, false>(pass_of);
            ++now.step;
            now.F_e = plucked ? m.pluck_at(now.step) : 0;
            at.act(points, contact.C, now.y_b, now.y_c, now.F_e, false);
            now.F_b = at.force.b;
            now.F_c = at.force.c;
            if (out.stopped(k, steps_between_questions)) return {};
            if (k + 1 == steps) break;
            now.impulse_b += now.F_b;
            now.impulse_c += now.F_c;
        }
        now.impulse_b += 0.5 * now.F_b;
        now.impulse_c += 0.5 * now.F_c;
        if (!(std::abs(now.y_b + now.y_c) < modal_overflow)) {
            status = {Outcome::diverged, now.step - 1};
            break;
        }
    }
    *s.pass = pass_of;
    contact.now = at;
    *s.state = now;
    return status;
}

SeriesAdvance choose_series(bool barrier, bool thread) {
    static constexpr SeriesAdvance table[2][2] = {{advance<false, false>, advance<false, true>},
                                                  {advance<true, false>, advance<true, true>}};
    return table[barrier][thread];
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose_series);

SeriesAdvance series_advance(bool barrier, bool thread) {
    return HWY_DYNAMIC_DISPATCH(choose_series)(barrier, thread);
}
}  // namespace jvari
#endif
