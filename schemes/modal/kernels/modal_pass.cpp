#include "schemes/modal/kernels/modal_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/modal_pass.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "schemes/modal/kernels/modal_pass-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
ModalPassFunction choose_two_point(bool barrier, bool thread, bool pluck) {
    static constexpr ModalPassFunction table[2][2][2] = {
        {{pass<false, false, false>, pass<false, false, true>}, {pass<false, true, false>, pass<false, true, true>}},
        {{pass<true, false, false>, pass<true, false, true>}, {pass<true, true, false>, pass<true, true, true>}}};
    return table[barrier][thread][pluck];
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
HWY_EXPORT(dot_of_pass);

ModalPassFunction two_point_pass(bool barrier, bool thread, bool pluck) {
    return HWY_DYNAMIC_DISPATCH(choose_two_point)(barrier, thread, pluck);
}
double pass_dot(const double* w, const double* x, int size) {
    return HWY_DYNAMIC_DISPATCH(dot_of_pass)(w, x, size);
}
}  // namespace jvari
#endif
