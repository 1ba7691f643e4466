#include "schemes/grid/grid_solve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/grid/grid_solve.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "schemes/grid/neighbours-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// x_-k = -x_k, x_{N+k} = -x_{N-k}, k <= reach
HWY_INLINE void mirror(double* HWY_RESTRICT x, int N, int reach) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    x[0] = x[N] = 0;
    for (int k = 0; k < reach; k += lanes) {
        hn::StoreU(hn::Neg(hn::Reverse(d, hn::LoadU(d, x + 1 + k))), d, x - k - lanes);
        hn::StoreU(hn::Neg(hn::Reverse(d, hn::LoadU(d, x + N - k - lanes))), d, x + N + 1 + k);
    }
}

// out_l = c_0 x_l + sum_k c_k (x_{l - k step} + x_{l + k step}) for `vectors` vectors along l. If a
// vector holds several steps, they read the same neighbours, in memory once.
template <int pairs, int step, int vectors, int... j>
HWY_INLINE void sum_at(int l, const double* HWY_RESTRICT c, const double* HWY_RESTRICT x,
                       double* HWY_RESTRICT out, std::integer_sequence<int, j...>) {
    const D d;
    constexpr int lanes = hn::MaxLanes(D()), apart = lanes / step;
    const hn::Vec<D> near[] = {neighbour<(j - pairs) * step>(x + l)...};
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) {
        const int mid = pairs + v * apart;
        auto even = hn::Mul(hn::Set(d, c[0]), near[mid]), odd = hn::Zero(d);
#pragma GCC unroll 16
        for (int k = 1; k <= pairs; ++k) {
            const auto both = hn::Add(near[mid - k], near[mid + k]);
            if (k % 2) odd = hn::MulAdd(hn::Set(d, c[k]), both, odd);
            else even = hn::MulAdd(hn::Set(d, c[k]), both, even);
        }
        hn::StoreU(hn::Add(even, odd), d, out + l + v * lanes);
    }
}
template <int pairs, int step>
HWY_INLINE void convolve(const double* HWY_RESTRICT c, int N, const double* HWY_RESTRICT x,
                         double* HWY_RESTRICT out) {
    constexpr int lanes = hn::MaxLanes(D()), vectors = lanes == 2 * step ? 2 : 1;
    int l = 1;
    for (; l + (vectors - 1) * lanes < N; l += vectors * lanes)
        sum_at<pairs, step, vectors>(
            l, c, x, out,
            std::make_integer_sequence<int, 2 * pairs + 1 + (vectors - 1) * lanes / step>());
    if (l < N)
        sum_at<pairs, step, 1>(l, c, x, out, std::make_integer_sequence<int, 2 * pairs + 1>());
}

template <int pairs>
void solve(const double* close, const double* far, int terms, int N, double* x, double* between,
           double* u) {
    mirror(x, N, pairs);
    convolve<pairs, 1>(close, N, x, between);
    mirror(between, N, 4 * (terms > 9 ? 15 : terms - 1));
    switch (terms) {
        case 1: convolve<0, 4>(far, N, between, u); break;
        case 2: convolve<1, 4>(far, N, between, u); break;
        case 3: convolve<2, 4>(far, N, between, u); break;
        case 4: convolve<3, 4>(far, N, between, u); break;
        case 5: convolve<4, 4>(far, N, between, u); break;
        case 6: convolve<5, 4>(far, N, between, u); break;
        case 7: convolve<6, 4>(far, N, between, u); break;
        case 8: convolve<7, 4>(far, N, between, u); break;
        case 9: convolve<8, 4>(far, N, between, u); break;
        default: convolve<15, 4>(far, N, between, u);  // the rest of `far` is zero
    }
    const D d;
    hn::StoreU(hn::Zero(d), d, u + N);
}

void midpoint(int N, double* HWY_RESTRICT y, double* HWY_RESTRICT q, const double* HWY_RESTRICT s) {
    const D d;
    for (int l = 1; l < N; l += static_cast<int>(hn::Lanes(d))) {
        const auto moved = hn::LoadU(d, s + l);
        hn::StoreU(hn::Add(hn::LoadU(d, y + l), moved), d, y + l);
        hn::StoreU(hn::Sub(moved, hn::LoadU(d, q + l)), d, q + l);
    }
    hn::StoreU(hn::Zero(d), d, q + N);
}
MidpointPass choose_midpoint() { return midpoint; }

void increment(int N, double* HWY_RESTRICT u, const double* HWY_RESTRICT before) {
    const D d;
    for (int l = 1; l < N; l += static_cast<int>(hn::Lanes(d)))
        hn::StoreU(hn::Add(hn::LoadU(d, u + l), hn::LoadU(d, before + l)), d, u + l);
    hn::StoreU(hn::Zero(d), d, u + N);
}
IncrementPass choose_increment() { return increment; }

using Sums = void (*)(const double*, const double*, int, int, double*, double*, double*);
Sums choose(int near) { return near <= 3 ? solve<3> : solve<6>; }

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose);
HWY_EXPORT(choose_midpoint);
HWY_EXPORT(choose_increment);
MidpointPass midpoint_pass() { return HWY_DYNAMIC_DISPATCH(choose_midpoint)(); }
IncrementPass increment_pass() { return HWY_DYNAMIC_DISPATCH(choose_increment)(); }

GridSolve::Sums GridSolve::sums(int pairs) { return HWY_DYNAMIC_DISPATCH(choose)(pairs); }

namespace {
using Real = long double;
struct Band {  // one symmetric convolution
    Real c0, c1, c2;
    Band next() const {  // A(z) A(-z), in z^2
        const Band b{c0 * c0 + 2 * c2 * c2 - 2 * c1 * c1, 2 * c0 * c2 - c1 * c1, c2 * c2};
        return {1, b.c1 / b.c0, b.c2 / b.c0};
    }
    Real scale() const { return c0 * c0 + 2 * c2 * c2 - 2 * c1 * c1; }  // divisor of next()
};

// One side of a symmetric sequence times A(-z^step).
std::vector<Real> times(const std::vector<Real>& x, const Band& a, int step) {
    const int reach = static_cast<int>(x.size()) - 1;
    std::vector<Real> y(reach + 2 * step + 1, 0.0L);
    const auto at = [&](int k) { return std::abs(k) <= reach ? x[std::abs(k)] : 0; };
    for (int k = 0; k < static_cast<int>(y.size()); ++k)
        y[k] = a.c0 * at(k) - a.c1 * (at(k - step) + at(k + step)) +
               a.c2 * (at(k - 2 * step) + at(k + 2 * step));
    return y;
}
}  // namespace

GridSolve::GridSolve(const Grid& g, double a0, double a2, double a4)
    : intervals_(g.intervals), factor_(g, a0, a2, a4) {
    from_ = AlignedVector(2 * offset + intervals_ + 1);
    between_ = AlignedVector(2 * offset + intervals_ + 1);
    const Real h2 = static_cast<Real>(g.dx) * g.dx, p = a2 / h2, q = a4 / (h2 * h2),
               diagonal = a0 - 2 * p + 6 * q;
    Band a{1, (p - 4 * q) / diagonal, q / diagonal};
    std::vector<Real> close{1 / diagonal}, far{1};
    for (int step = 1; step <= 2; step *= 2) {
        close = times(close, a, step);
        for (Real& x : close) x /= a.scale();
        a = a.next();
    }
    for (int step = 1; std::abs(a.c1) + std::abs(a.c2) > 1e-22L && far.size() < 1000; step *= 2) {
        far = times(far, a, step);
        for (Real& x : far) x /= a.scale();
        a = a.next();
    }
    Real rest = 0;
    while (far.size() > 1 && rest + 2 * std::abs(far.back()) < std::ldexp(Real(1), -58))
        rest += 2 * std::abs(far.back()), far.pop_back();
    // whole vectors
    const int terms = static_cast<int>(far.size()), reach = 4 * (terms > 9 ? most : terms) + 8;
    if (terms > most || reach >= intervals_) return;
    for (std::size_t k = 0; k < close.size() && k < near_.size(); ++k)
        near_[k] = static_cast<double>(close[k]);
    std::copy(far.begin(), far.end(), far_.begin());
    terms_ = terms;
    sums_ = sums(a4 != 0 ? near : near / 2);
}

void GridSolve::operator()(double* u) noexcept {
    double* x = input();
    if (!sums_) {
        std::copy_n(x + 1, intervals_ - 1, u + 1);
        u[0] = u[intervals_] = 0;
        factor_.solve(u);
        return;
    }
    sums_(near_.data(), far_.data(), terms_, intervals_, x, between_.data() + offset, u);
}

}  // namespace jvari
#endif
