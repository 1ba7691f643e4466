// Neighbours of the nodes in a vector, by vectors in the instruction set being compiled: included
// once for each, after Highway.
#if defined(JVARI_GRID_NEIGHBOURS) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_GRID_NEIGHBOURS
#undef JVARI_GRID_NEIGHBOURS
#else
#define JVARI_GRID_NEIGHBOURS
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;

// x[by], x[by + 1], ...; x[0] stands on a vector boundary. With AVX-512 the result is assembled
// from two aligned vectors: nearly every unaligned one would cross a cache line, which costs two
// loads.
template <int by>
HWY_INLINE hn::Vec<D> neighbour(const double* HWY_RESTRICT x) {
    const D d;
#if HWY_ARCH_X86 && HWY_MAX_BYTES == 64
    constexpr int part = by & 7;
    if constexpr (part != 0) {
        const __m512i low = _mm512_castpd_si512(hn::LoadU(d, x + by - part).raw),
                      high = _mm512_castpd_si512(hn::LoadU(d, x + by - part + 8).raw);
        return hn::Vec<D>{_mm512_castsi512_pd(_mm512_alignr_epi64(high, low, part))};
    }
#endif
    return hn::LoadU(d, x + by);
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();
#endif
