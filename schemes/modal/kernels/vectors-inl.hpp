// Vectors for the modal kernels, and their sum of products: two accumulators hide the latency of
// adding. Highway compiles this once per instruction set.
#if defined(JVARI_MODAL_VECTORS) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_MODAL_VECTORS
#undef JVARI_MODAL_VECTORS
#else
#define JVARI_MODAL_VECTORS
#endif

#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

// Sum over w x. size: a multiple of twice the lanes.
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

// Sums over the lanes of four vectors at once, each by halving halves: fewer shuffles than four
// separate sums need, and a single store, so that vectors can read the sums without delay.
HWY_INLINE void sums(V a, V b, V c, V e, double* HWY_RESTRICT to) {
    const D d;
#if HWY_MAX_BYTES >= 64 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
    const hn::CappedTag<double, 4> four;
    const V ac = hn::Add(hn::ConcatLowerLower(d, c, a), hn::ConcatUpperUpper(d, c, a));
    const V be = hn::Add(hn::ConcatLowerLower(d, e, b), hn::ConcatUpperUpper(d, e, b));
    const V pairs = hn::Add(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(be), ac),
                            hn::OddEvenBlocks(be, hn::SwapAdjacentBlocks(ac)));
    const V all = hn::Add(pairs, hn::Shuffle01(pairs));  // a a b b c c e e
    hn::StoreU(hn::LowerHalf(four, hn::ConcatEven(d, all, all)), four, to);
#elif HWY_MAX_BYTES == 32
    const V ac = hn::Add(hn::ConcatLowerLower(d, c, a), hn::ConcatUpperUpper(d, c, a));
    const V be = hn::Add(hn::ConcatLowerLower(d, e, b), hn::ConcatUpperUpper(d, e, b));
    hn::StoreU(hn::Add(hn::InterleaveLower(d, ac, be), hn::InterleaveUpper(d, ac, be)), d, to);
#else
    to[0] = hn::GetLane(hn::SumOfLanes(d, a));
    to[1] = hn::GetLane(hn::SumOfLanes(d, b));
    to[2] = hn::GetLane(hn::SumOfLanes(d, c));
    to[3] = hn::GetLane(hn::SumOfLanes(d, e));
#endif
}

// Keeps v in a register from here on: GCC 12 otherwise reads v from memory at each use, three loads
// instead of a single one, and a pass waits for its loads.
HWY_INLINE V in_register(V v) {
#if HWY_ARCH_X86 && HWY_COMPILER_GCC && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
    asm("" : "+v"(v.raw));
#endif
    return v;
}

// Makes the compiler read these doubles again.
HWY_INLINE double* again(double* at) {
#if HWY_ARCH_X86 && HWY_COMPILER_GCC
    asm("" : "+r"(at));
#endif
    return at;
}

// Calls pass.run<pushing>(places) with the points that have a force, so that a pass leaves out
// products with zero: `pushing` has a bit for each, or is by_place(count) with their places.
constexpr int by_place(int count) { return -count; }
template <int points, int p, class Pass>
HWY_INLINE void with_one(int at, const Pass& pass) {
    if constexpr (p + 1 == points) pass.template run<1 << p>(nullptr);
    else if (at == p) pass.template run<1 << p>(nullptr);
    else with_one<points, p + 1>(at, pass);
}
template <int points, class HasForce, class Pass>
HWY_INLINE void with_forces(const HasForce& has_force, const Pass& pass) {
    int count = 0, at[points + 1] = {};
    for (int p = 0; p < points; ++p)
        if (has_force(p)) at[count++] = p;
    if (count == 0) pass.template run<0>(nullptr);
    else if (points > 1 && count == 1) with_one<std::max(points, 1), 0>(at[0], pass);
    else if (points > 3 && count == 2) pass.template run<by_place(2)>(at);
    else pass.template run<(1 << points) - 1>(nullptr);
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();
#endif
