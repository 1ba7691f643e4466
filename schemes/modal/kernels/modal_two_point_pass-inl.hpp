// Pass over the modes for modal_two_point_kernel.hpp, with the closing sums over lanes. Highway
// compiles it once per instruction set.
#if defined(JVARI_MODAL_TWO_POINT_PASS) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_MODAL_TWO_POINT_PASS
#undef JVARI_MODAL_TWO_POINT_PASS
#else
#define JVARI_MODAL_TWO_POINT_PASS
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "schemes/modal/kernels/modal_two_point_kernel.hpp"
#include "schemes/modal/kernels/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Column = TwoPointColumn;
constexpr int any_number = -1;  // points counted at run time

// dot() with a column in the modes.
HWY_INLINE double dot(const double* HWY_RESTRICT w, const TwoPointStream& m, Column x) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    V even = hn::Zero(d), odd = hn::Zero(d);
    for (int i = 0; i < m.size; i += 2 * N) {
        even = hn::MulAdd(hn::Load(d, w + i), hn::Load(d, m.stream + m.at(x, i)), even);
        odd = hn::MulAdd(hn::Load(d, w + i + N), hn::Load(d, m.stream + m.at(x, i + N)), odd);
    }
    return hn::GetLane(hn::SumOfLanes(d, hn::Add(even, odd)));
}

struct NewMode {
    V y, u;
};
// Moves a vector of modes under the points' forces.
HWY_INLINE NewMode step_of(double* HWY_RESTRICT line, V forced) {
    const D d;
    const auto of = [&](Column q) HWY_ATTR __attribute__((always_inline)) {
        return line + static_cast<int>(q) * TwoPointStream::line;
    };
    const V s = hn::Add(hn::Load(d, of(Column::u)), forced);  // (41)
    const V y = hn::Add(hn::Load(d, of(Column::y)), s);       // (40)
    const V u = hn::NegMulAdd(hn::Load(d, of(Column::c)), y,
                              hn::NegMulAdd(hn::Load(d, of(Column::loss)), s, hn::Add(s, forced)));
    hn::Store(u, d, of(Column::u));
    hn::Store(y, d, of(Column::y));
    return {y, u};
}

// Makes a single pass: the update and the next dots. The number of points is a template argument,
// so that an absent point costs nothing. Two accumulators per dot hide the latency of adding.
// pushing: the points with a force, a bit for each, or by_place(count): those at `places`.
template <int points, bool dots_of_y, int pushing>
HWY_INLINE void few_points(TwoPointStream& m, const double* HWY_RESTRICT force, const int* places) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    constexpr int some = points > 0 ? points : 1, columns = static_cast<int>(Column::g) + points,
                  placed = std::max(-pushing, 0);
    V F[some], y[some][2], u[some][2];
    for (int p = 0; p < some; ++p) {
        F[p] = hn::Set(d, points > 0 ? force[p < placed ? places[p] : p] : 0);
        for (int k = 0; k < 2; ++k) y[p][k] = u[p][k] = hn::Zero(d);
    }
    double* HWY_RESTRICT stream = m.stream;
    const auto at = [&](int j, int k) HWY_ATTR __attribute__((always_inline)) {
        double* HWY_RESTRICT line =
            stream + (N == TwoPointStream::line ? j * columns : m.at(Column::y, j));
        V g[some], forced = hn::Zero(d);
        const auto weight = [&](int p) HWY_ATTR __attribute__((always_inline)) {
            return hn::Load(d, line + (static_cast<int>(Column::g) + p) * TwoPointStream::line);
        };
        for (int p = 0; p < placed; ++p) forced = hn::MulAdd(weight(places[p]), F[p], forced);
        for (int p = points - 1; p >= 0; --p) {
            g[p] = in_register(weight(p));
            if (pushing > 0 && pushing >> p & 1) forced = hn::MulAdd(g[p], F[p], forced);
        }
        const NewMode next = step_of(line, forced);
        for (int p = 0; p < points; ++p) {
            if constexpr (dots_of_y) y[p][k] = hn::MulAdd(g[p], next.y, y[p][k]);
            u[p][k] = hn::MulAdd(g[p], next.u, u[p][k]);
        }
    };
    int i = 0;
    for (; i + N < m.modes; i += 2 * N) {
        at(i, 0);
        at(i + N, 1);
    }
    if (i < m.modes) at(i, 0);
    const auto put = [](const V(&v)[some][2], double* to) HWY_ATTR {  // four at a time
        const auto both = [&](int p) HWY_ATTR {
            const int q = p < points ? p : points - 1;
            return hn::Add(v[q][0], v[q][1]);
        };
        for (int p = 0; p < points; p += 4) {
            alignas(64) double sum[4];
            sums(both(p), both(p + 1), both(p + 2), both(p + 3), sum);
            for (int q = p; q < points && q < p + 4; ++q) to[q] = sum[q - p];
        }
    };
    put(u, m.u);
    if constexpr (dots_of_y) put(y, m.y);
}

// Any number of points: the sums pass through memory, a line at a time.
template <bool dots_of_y>
HWY_INLINE void many_points(TwoPointStream& m, const double* HWY_RESTRICT force) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d)), points = m.points;
    constexpr int line_size = TwoPointStream::line;
    double *HWY_RESTRICT of_u = m.sums, *HWY_RESTRICT of_y = m.sums + points * line_size;
    for (int j = 0; j < 2 * points * line_size; ++j) m.sums[j] = 0;
    for (int i = 0; i < m.modes; i += N) {
        double *HWY_RESTRICT line = m.stream + m.at(Column::y, i),
                             *HWY_RESTRICT g = m.stream + m.at(Column::g, i);
        const int k = i % line_size;
        V forced = hn::Zero(d);
        for (int p = 0; p < points; ++p)
            forced = hn::MulAdd(hn::Load(d, g + p * line_size), hn::Set(d, force[p]), forced);
        const NewMode next = step_of(line, forced);
        for (int p = 0; p < points; ++p) {
            const V weight = hn::Load(d, g + p * line_size);
            double *u = of_u + p * line_size + k, *y = of_y + p * line_size + k;
            hn::Store(hn::MulAdd(weight, next.u, hn::Load(d, u)), d, u);
            if constexpr (dots_of_y) hn::Store(hn::MulAdd(weight, next.y, hn::Load(d, y)), d, y);
        }
    }
    const auto sum = [&](const double* of) HWY_ATTR {
        V all = hn::Zero(d);
        for (int k = 0; k < line_size; k += N) all = hn::Add(all, hn::Load(d, of + k));
        return hn::GetLane(hn::SumOfLanes(d, all));
    };
    for (int p = 0; p < points; ++p) {
        m.u[p] = sum(of_u + p * line_size);
        if constexpr (dots_of_y) m.y[p] = sum(of_y + p * line_size);
    }
}

template <int points, bool dots_of_y>
struct FewPoints {
    TwoPointStream& m;
    const double* force;
    template <int pushing>
    HWY_INLINE void run(const int* places) const {
        few_points<points, dots_of_y, pushing>(m, force, places);
    }
};
template <int points, bool dots_of_y>
HWY_INLINE void pass(TwoPointStream& m, const double* force) {
    if constexpr (points == any_number) many_points<dots_of_y>(m, force);
    else
        with_forces<points>([&](int p) { return force[p] != 0; },
                            FewPoints<points, dots_of_y>{m, force});
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();
#endif
