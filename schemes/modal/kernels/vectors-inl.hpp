// The vectors of the modal kernels, and their sum of products: two accumulators hide the latency of
// adding. Compiled once per instruction set by Highway.
#if defined(JVARI_MODAL_VECTORS) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_MODAL_VECTORS
#undef JVARI_MODAL_VECTORS
#else
#define JVARI_MODAL_VECTORS
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

// Sum of w x. size: a multiple of twice the lanes.
HWY_INLINE double dot(const double* HWY_RESTRICT w, const double* HWY_RESTRICT x, int size) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    V even = hn::Zero(d), odd = hn::Zero(d);
    for (int i = 0; i < size; i += 2 * N) {
        even = hn::MulAdd(hn::Load(d, w + i), hn::Load(d, x + i), even);
        odd = hn::MulAdd(hn::Load(d, w + i + N), hn::Load(d, x + i + N), odd);
    }
    return hn::GetLane(hn::SumOfLanes(d, hn::Add(even, odd)));
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();
#endif
