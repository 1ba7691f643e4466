// Pass of the two-moment string, and its fused rows; Highway compiles both once per instruction
// set. The number of points is a template argument up to five, so that absent points cost nothing.
#include "schemes/modal/kernels/two_moment_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/two_moment_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "schemes/modal/kernels/fused_rows-inl.hpp"
#include "schemes/modal/kernels/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

namespace {
using Stream = TwoMomentStream;
constexpr int any_number = -1;  // points counted at run time

// Sums on_a a + on_b b, for several weights in one pass.
template <int count>
HWY_INLINE void sums_of(const double* const* on_a, const double* const* on_b, const Stream& m,
                        double* to) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d)), step = m.columns() * Stream::line;
    V of_a[count], of_b[count];
    for (int t = 0; t < count; ++t) of_a[t] = of_b[t] = hn::Zero(d);
    const double* HWY_RESTRICT line = m.stream;
    for (int i = 0; i < m.modes; i += Stream::line, line += step)
        for (int k = 0; k < Stream::line; k += N) {
            const V a = in_register(hn::Load(d, line + Stream::a * Stream::line + k)),
                    b = in_register(hn::Load(d, line + Stream::b * Stream::line + k));
            for (int t = 0; t < count; ++t) {
                of_a[t] = hn::MulAdd(hn::Load(d, on_a[t] + i + k), a, of_a[t]);
                of_b[t] = hn::MulAdd(hn::Load(d, on_b[t] + i + k), b, of_b[t]);
            }
        }
    for (int t = 0; t < count; ++t)
        to[t] = hn::GetLane(hn::SumOfLanes(d, hn::Add(of_a[t], of_b[t])));
}

// Sums over the lanes of an even number of vectors.
template <int count>
HWY_INLINE void put_sums(const V* sum, double* HWY_RESTRICT to) {
    for (int c = 0; c + 4 <= count; c += 4)
        sums(sum[c], sum[c + 1], sum[c + 2], sum[c + 3], to + c);
    if constexpr (count % 4 != 0) {
        alignas(64) double four[4];
        const V &a = sum[count - 2], &b = sum[count - 1];
        sums(a, b, a, b, four);
        to[count - 2] = four[0], to[count - 1] = four[1];
    }
}

// pushing: the contacts that push, a bit for each, or by_place(count): those at `places`. A thread
// always pulls.
template <int points, bool thread, int pushing>
HWY_INLINE void few_points(Stream& m, const double* HWY_RESTRICT phi, const int* places) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    constexpr int columns = Stream::weights + 2 * points, some = points > 0 ? points : 1,
                  placed = std::max(-pushing, 0),
                  pull = std::max(pushing, 0) | (thread ? 1 << (points - 1) : 0);
    // Weights for both uses stay in registers. With more of them sums would move to memory, where
    // each addition waits: these weights are read twice.
    constexpr int pulls = std::popcount(static_cast<unsigned>(pull));
    constexpr bool stay =
        points <= 2 || pulls <= 1 || (HWY_TARGET <= HWY_AVX3 && 2 * points + 4 * pulls <= 24);
    V force_0[some], force_1[some], sum[2 * some], by_0[placed + 1], by_1[placed + 1];
    std::ptrdiff_t from[placed + 1];
    for (int k = 0; k < placed; ++k) {
        from[k] = (Stream::weights + places[k]) * Stream::line;
        by_0[k] = hn::Set(d, phi[places[k]]), by_1[k] = hn::Set(d, phi[points + places[k]]);
    }
    const V zero = in_register(hn::Zero(d));
    for (int p = 0; p < points; ++p) {
        force_0[p] = hn::Set(d, phi[p]), force_1[p] = hn::Set(d, phi[points + p]);
        sum[p] = sum[points + p] = zero;
    }
    double* HWY_RESTRICT line = m.stream;
    for (int i = 0; i < m.modes; i += Stream::line, line += columns * Stream::line)
        for (int k = 0; k < Stream::line; k += N) {
            double* HWY_RESTRICT q = line + k;
            const auto load = [&](int column) HWY_ATTR __attribute__((always_inline)) {
                return hn::Load(d, q + column * Stream::line);
            };
            V a = in_register(load(Stream::a)), b = in_register(load(Stream::b)), w[2 * some];
            for (int j = 0; j < placed; ++j) {
                b = hn::MulAdd(hn::Load(d, q + from[j]), by_0[j], b);
                a = hn::MulAdd(hn::Load(d, q + from[j] + points * Stream::line), by_1[j], a);
            }
            for (int p = 0; p < points; ++p) {
                if (!(pull >> p & 1)) continue;
                for (int c = p; c < 2 * points; c += points) {
                    w[c] = load(Stream::weights + c);
                    if (stay) w[c] = in_register(w[c]);
                }
                b = hn::MulAdd(w[p], force_0[p], b);  // (2)
                a = hn::MulAdd(w[points + p], force_1[p], a);
            }
            const V turn = in_register(load(Stream::A12)),  // (3)
                new_a = hn::MulAdd(load(Stream::A11), a, hn::Mul(turn, b)),
                    new_b = hn::NegMulAdd(turn, a, hn::Mul(load(Stream::A22), b));
            hn::Store(new_a, d, q + Stream::a * Stream::line);
            hn::Store(new_b, d, q + Stream::b * Stream::line);
            if (!stay) q = again(q);
            for (int c = 0; c < 2 * points; ++c) {  // (1)
                if (!stay || !(pull >> c % some & 1)) w[c] = load(Stream::weights + c);
                sum[c] = hn::MulAdd(w[c], c < points ? new_b : new_a, sum[c]);
            }
        }
    put_sums<2 * points>(sum, m.free);
}

// Any number of points: forces and sums pass through memory, a line at a time.
HWY_INLINE void many_points(Stream& m, const double* HWY_RESTRICT phi, bool forced) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d)), points = m.points,
              columns = Stream::weights + 2 * points, from = forced ? 0 : points - m.thread;
    double* HWY_RESTRICT line = m.stream;
    double* HWY_RESTRICT sums = m.free;
    for (int j = 0; j < 2 * points * Stream::line; ++j) sums[j] = 0;
    for (int i = 0; i < m.modes; i += Stream::line, line += columns * Stream::line)
        for (int k = 0; k < Stream::line; k += N) {
            double* HWY_RESTRICT q = line + k;
            const auto load = [&](int column) HWY_ATTR __attribute__((always_inline)) {
                return hn::Load(d, q + column * Stream::line);
            };
            V a = load(Stream::a), b = load(Stream::b);
            for (int p = from; p < points; ++p) {
                b = hn::MulAdd(load(Stream::weights + p), hn::Set(d, phi[p]), b);
                a = hn::MulAdd(load(Stream::weights + points + p), hn::Set(d, phi[points + p]), a);
            }
            const V turn = load(Stream::A12),
                    new_a = hn::MulAdd(load(Stream::A11), a, hn::Mul(turn, b)),
                    new_b = hn::NegMulAdd(turn, a, hn::Mul(load(Stream::A22), b));
            hn::Store(new_a, d, q + Stream::a * Stream::line);
            hn::Store(new_b, d, q + Stream::b * Stream::line);
            for (int p = 0; p < points; ++p) {
                double *s_0 = sums + p * Stream::line + k,
                       *s_1 = sums + (points + p) * Stream::line + k;
                hn::Store(hn::MulAdd(load(Stream::weights + p), new_b, hn::Load(d, s_0)), d, s_0);
                hn::Store(hn::MulAdd(load(Stream::weights + points + p), new_a, hn::Load(d, s_1)),
                          d, s_1);
            }
        }
    for (int p = 0; p < 2 * points; ++p) {
        V sum = hn::Zero(d);
        for (int k = 0; k < Stream::line; k += N)
            sum = hn::Add(sum, hn::Load(d, sums + p * Stream::line + k));
        sums[p] = hn::GetLane(hn::SumOfLanes(d, sum));  // behind all sums that are still to be read
    }
}

template <int points, bool thread>
struct FewPoints {
    Stream& m;
    const double* phi;
    template <int pushing>
    HWY_INLINE void run(const int* places) const {
        few_points<points, thread, pushing>(m, phi, places);
    }
};
template <int points, bool thread>
HWY_INLINE void pass(Stream& m, const double* phi) {
    const auto has_force = [&](int a) { return phi[a] != 0 || phi[m.points + a] != 0; };
    if constexpr (points == any_number) {
        bool contacts = false;
        for (int a = 0; a < m.points - m.thread; ++a) contacts = contacts || has_force(a);
        many_points(m, phi, contacts);
    } else {
        with_forces<points - thread>(has_force, FewPoints<points, thread>{m, phi});
    }
}
template <int points, bool thread>
void pass_of(Stream& m, const double* phi) {
    pass<points, thread>(m, phi);
}

// Taps that read modes, two at a time in one pass: a tap and the next such tap.
class TapPairs {
public:
    TapPairs(const Stream& m, const FusedTap* taps, int count)
        : m_(m), taps_(taps), count_(count) {}
    HWY_INLINE double read(int k) {
        if (!taps_[k].on_first) return 0;
        if (std::exchange(waits_, false)) return sums_[1];
        const double *on_a[2] = {}, *on_b[2] = {};
        int found = 0;
        for (; k < count_ && found < 2; ++k)
            if (const FusedTap& t = taps_[k]; t.on_first)
                on_a[found] = t.on_first, on_b[found++] = t.on_second;
        waits_ = found == 2;
        if (waits_) sums_of<2>(on_a, on_b, m_, sums_);
        else sums_of<1>(on_a, on_b, m_, sums_);
        return sums_[0];
    }

private:
    const Stream& m_;
    const FusedTap* taps_;
    int count_;
    double sums_[2] = {};
    bool waits_ = false;  // the second sum for its tap
};

template <int points, bool thread, bool series>
bool rows_of(Stream& m, MomentObstacle& at, const Block& out, RowsInHand& r) {
    TapPairs taps(m, r.taps, out.taps);
    return make_rows(
        m.points, r.force, out, r, [&](int k) HWY_ATTR { return taps.read(k); },
        [&] { return at.forces(0); },
        [&](double* force) HWY_ATTR { return at.step<points, thread, series>(m.free, force); },
        [&](const double* force) HWY_ATTR { pass<points, thread>(m, force); });
}
template <int points, bool thread>
bool rows_without(Stream& m, MomentObstacle& at, const Block& out, RowsInHand& r) {
    return rows_of<points, thread, false>(m, at, out, r);
}
template <int points, bool thread>
bool rows_with(Stream& m, MomentObstacle& at, const Block& out, RowsInHand& r) {
    return rows_of<points, thread, true>(m, at, out, r);
}
}  // namespace

// [thread][points]: up to five, then any number
#define JVARI_BY_POINTS(function)                                                                \
    {                                                                                            \
        {function<0, false>, function<1, false>, function<2, false>,         function<3, false>, \
         function<4, false>, function<5, false>, function<any_number, false>},                   \
        {                                                                                        \
            function<any_number, true>, function<1, true>, function<2, true>, function<3, true>, \
                function<4, true>, function<5, true>, function<any_number, true>                 \
        }                                                                                        \
    }
TwoMomentPass choose_moment_pass(int points, bool thread) {
    static constexpr TwoMomentPass table[2][7] = JVARI_BY_POINTS(pass_of);
    return table[thread][points <= 5 ? points : 6];
}
TwoMomentRowsKernel choose_moment_rows(int points, bool thread, bool series) {
    static constexpr TwoMomentRowsKernel with[2][7] = JVARI_BY_POINTS(rows_with),
                                         without[2][7] = JVARI_BY_POINTS(rows_without);
    return (series ? with : without)[thread][points <= 5 ? points : 6];
}
#undef JVARI_BY_POINTS
double sum_of_columns(const double* on_a, const double* on_b, const TwoMomentStream& m) {
    double sum;
    sums_of<1>(&on_a, &on_b, m, &sum);
    return sum;
}
TwoMomentSum choose_moment_sum() { return sum_of_columns; }

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose_moment_pass);
HWY_EXPORT(choose_moment_rows);
HWY_EXPORT(choose_moment_sum);

TwoMomentPass two_moment_pass(int points, bool thread) {
    return HWY_DYNAMIC_DISPATCH(choose_moment_pass)(points, thread);
}
TwoMomentRowsKernel two_moment_rows(int points, bool thread, bool series) {
    return HWY_DYNAMIC_DISPATCH(choose_moment_rows)(points, thread, series);
}
TwoMomentSum two_moment_sum() { return HWY_DYNAMIC_DISPATCH(choose_moment_sum)(); }
}  // namespace jvari
#endif
