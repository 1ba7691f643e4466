#include "schemes/modal/kernels/modal_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/modal_pass.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "schemes/modal/kernels/modal_pass-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
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
double dot_of_pass(const double* w, const double* x, int size) {
    return dot(w, x, size);
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose_two_point);
HWY_EXPORT(choose_three_point);
HWY_EXPORT(choose_ahead);
HWY_EXPORT(dot_of_pass);

ModalPassFunction two_point_pass(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_two_point)(barrier, thread, pluck);
}
ModalPassFunction three_point_pass(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_three_point)(barrier, thread, pluck);
}
ModalPassFunction three_point_pass_ahead(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_ahead)(barrier, thread, pluck);
}
double pass_dot(const double* w, const double* x, int size) {
    return HWY_DYNAMIC_DISPATCH(dot_of_pass)(w, x, size);
}
}  // namespace jvari
#endif
