#include "schemes/grid/five_point_pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/grid/five_point_pass.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "schemes/grid/neighbours-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool loss_in_space>
void pass(const FivePointWeights& w, int intervals, double* HWY_RESTRICT next,
          const double* HWY_RESTRICT now, const double* HWY_RESTRICT before,
          double* HWY_RESTRICT kept) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto a0 = hn::Set(d, w.a0), a1 = hn::Set(d, w.a1), a2 = hn::Set(d, w.a2),
               b0 = hn::Set(d, w.b0), b1 = hn::Set(d, w.b1), b2 = hn::Set(d, w.b2);
    for (int l = 1; l < intervals; l += lanes) {
        const auto p = hn::Add(neighbour<-1>(now + l), neighbour<1>(now + l));
        const auto q = hn::Add(neighbour<-2>(now + l), neighbour<2>(now + l));
        auto sum = hn::MulAdd(a2, q, hn::MulAdd(a1, p, hn::Mul(a0, hn::LoadU(d, now + l))));
        sum = hn::MulAdd(b0, hn::LoadU(d, before + l), sum);
        if constexpr (loss_in_space) {
            sum = hn::Add(sum, hn::LoadU(d, kept + l));
            hn::StoreU(hn::MulAdd(b2, q, hn::Mul(b1, p)), d, kept + l);
        }
        hn::StoreU(sum, d, next + l);
    }
    // clears the end, and the last vector's overhang
    hn::StoreU(hn::Zero(d), d, next + intervals);
}

FivePointPass choose(bool loss_in_space) { return loss_in_space ? pass<true> : pass<false>; }

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose);

FivePointPass five_point_pass(const FivePointWeights& w) {
    return HWY_DYNAMIC_DISPATCH(choose)(w.b1 != 0 || w.b2 != 0);
}
}  // namespace jvari
#endif
