// Reads four vectors of modes at a time to hide the latency of the recurrences; a block's
// derivatives are kept for all outputs.
#include "reference/exact/modal_sweep.hpp"

#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/exact/modal_sweep.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr double inverse_factorials[32] = {1.0 / 1,
                                           1.0 / 1,
                                           1.0 / 2,
                                           1.0 / 6,
                                           1.0 / 24,
                                           1.0 / 120,
                                           1.0 / 720,
                                           1.0 / 5040,
                                           1.0 / 40320,
                                           1.0 / 362880,
                                           1.0 / 3628800,
                                           1.0 / 39916800,
                                           1.0 / 479001600,
                                           1.0 / 6227020800,
                                           1.0 / 87178291200,
                                           1.0 / 1307674368000,
                                           1.0 / 20922789888000,
                                           1.0 / 355687428096000,
                                           1.0 / 6402373705728000,
                                           1.0 / 121645100408832000,
                                           1.0 / 2432902008176640000,
                                           1.0 / 51090942171709440000.0,
                                           1.0 / 1124000727777607680000.0,
                                           1.0 / 25852016738884976640000.0,
                                           1.0 / 620448401733239439360000.0,
                                           1.0 / 15511210043330985984000000.0,
                                           1.0 / 403291461126605635584000000.0,
                                           1.0 / 10888869450418352160768000000.0,
                                           1.0 / 304888344611713860501504000000.0,
                                           1.0 / 8841761993739701954543616000000.0,
                                           1.0 / 265252859812191058636308480000000.0,
                                           1.0 / 8222838654177922817725562880000000.0};

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

// Adds to the first outputs from the derivatives that were kept.
template <int K>
HWY_INLINE void add_kept(const ModalSweep& m, int i, int others, int terms,
                         double* HWY_RESTRICT sum, const double* HWY_RESTRICT kept) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d)), stride = m.count;
    V g[K];
    for (int o = 0; o < others; ++o) {
        for (int k = 0; k < K; ++k)
            g[k] = hn::LoadU(d, m.weights + static_cast<long>(o) * m.modes + i + k * N);
        for (int n = 0; n < terms; ++n) {
            double* out = sum + (o * (stride + 1) + n) * N;
            V total = hn::LoadU(d, out);
            for (int k = 0; k < K; ++k)
                total = hn::MulAdd(g[k], hn::LoadU(d, kept + (n * K + k) * N), total);
            hn::StoreU(total, d, out);
        }
    }
}

// Reads K vectors of modes from i on, scaled by `base`: the last output is their sum. One or two
// outputs are summed on the way; for more the derivatives are kept.
template <int fixed_outputs, int K>
HWY_INLINE void read_block(const ModalSweep& m, int i, double* HWY_RESTRICT sum,
                           double* HWY_RESTRICT kept) {
    constexpr bool keep = fixed_outputs < 0;
    constexpr int fixed_others = keep ? 0 : fixed_outputs - 1;
    const D d;
    const int N = static_cast<int>(hn::Lanes(d)), stride = m.count,
              others = keep ? m.outputs - 1 : fixed_others;
    const int terms = m.terms[i / sweep_lanes];
    V d0[K], d1[K], a[K], b[K], g[fixed_others + 1][K];
    for (int k = 0; k < K; ++k) {
        const int at = i + k * N;
        const V base = hn::LoadU(d, m.base + at);
        a[k] = hn::LoadU(d, m.a + at);
        b[k] = hn::LoadU(d, m.b + at);
        d0[k] = hn::Mul(base, hn::LoadU(d, m.y + at));
        d1[k] = hn::Mul(base, hn::LoadU(d, m.u + at));
    }
    const auto load_weights = [&](int o, V* w) {
        for (int k = 0; k < K; ++k)
            w[k] = hn::LoadU(d, m.weights + static_cast<long>(o) * m.modes + i + k * N);
    };
    V size[K];
    for (int k = 0; k < K; ++k) size[k] = hn::Add(hn::Abs(d0[k]), hn::Abs(d1[k]));
    for (int o = 0; o < others; ++o) {
        V* w = g[keep ? 0 : o];
        load_weights(o, w);
        V total = hn::LoadU(d, sum + (o * (stride + 1) + stride) * N);
        for (int k = 0; k < K; ++k) total = hn::MulAdd(hn::Abs(w[k]), size[k], total);
        hn::StoreU(total, d, sum + (o * (stride + 1) + stride) * N);
    }
    double* HWY_RESTRICT own = sum + others * (stride + 1) * N;
    V reach = hn::LoadU(d, own + stride * N);
    for (int k = 0; k < K; ++k) reach = hn::Add(size[k], reach);
    hn::StoreU(reach, d, own + stride * N);
    for (int n = 0; n < terms; ++n) {
        for (int o = 0; o < fixed_others; ++o) {
            double* out = sum + (o * (stride + 1) + n) * N;
            V total = hn::LoadU(d, out);
            for (int k = 0; k < K; ++k) total = hn::MulAdd(g[o][k], d0[k], total);
            hn::StoreU(total, d, out);
        }
        V total = hn::LoadU(d, own + n * N);
        for (int k = 0; k < K; ++k) total = hn::Add(d0[k], total);
        hn::StoreU(total, d, own + n * N);
        for (int k = 0; k < K; ++k) {
            if (keep) hn::StoreU(d0[k], d, kept + (n * K + k) * N);
            const V next = hn::NegMulSub(a[k], d1[k], hn::Mul(b[k], d0[k]));
            d0[k] = d1[k];
            d1[k] = next;
        }
    }
    if (keep) add_kept<K>(m, i, others, terms, sum, kept);
}
template <int outputs>
void read_blocks(const ModalSweep& m, double* HWY_RESTRICT sum, double* HWY_RESTRICT kept) {
    const int N = static_cast<int>(hn::Lanes(D()));
    int i = 0;
    for (; i + 4 * N <= m.modes; i += 4 * N) read_block<outputs, 4>(m, i, sum, kept);
    for (; i < m.modes; i += N) read_block<outputs, 1>(m, i, sum, kept);
}
// Sums over the lanes of N vectors, one in each lane.
HWY_INLINE V fold(const double* rows) {
    const D d;
#if HWY_TARGET == HWY_SCALAR
    return hn::LoadU(d, rows);
#else
    const int N = static_cast<int>(hn::Lanes(d));
    V r[8];
    for (int i = 0; i < N; ++i) r[i] = hn::LoadU(d, rows + i * N);
    for (int width = N / 2; width > 0; width /= 2)
        for (int i = 0; i < width; ++i)
            r[i] = hn::Add(hn::ConcatEven(d, r[2 * i + 1], r[2 * i]),
                           hn::ConcatOdd(d, r[2 * i + 1], r[2 * i]));
    return r[0];
#endif
}
void read(const ModalSweep& m) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d)), outputs = m.outputs, stride = m.count;
    if (outputs == 0) return;
    // [output][stride + 1][N], reach the last
    double* HWY_RESTRICT sum = m.scratch;
    double* HWY_RESTRICT kept = m.scratch + outputs * (stride + 1) * N;  // [term][K][N]
    for (int i = 0; i < outputs * (stride + 1) * N; i += N) hn::StoreU(hn::Zero(d), d, sum + i);
    if (outputs == 1) read_blocks<1>(m, sum, kept);
    else if (outputs == 2) read_blocks<2>(m, sum, kept);
    else read_blocks<-1>(m, sum, kept);
    for (int o = 0; o < outputs; ++o) {
        const double* of_output = sum + o * (stride + 1) * N;
        for (int n = 0; n < stride; n += N)
            hn::StoreU(fold(of_output + n * N), d, m.p + o * m.stride + n);
        m.reach[o] = hn::GetLane(hn::SumOfLanes(d, hn::LoadU(d, of_output + stride * N)));
    }
}

template <int forces, int K>
HWY_INLINE void move_block(const ModalSweep& m, int i) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    const int count = forces < 0 ? m.forces : forces;
    V Y[K], U[K], a[K], b[K], g[K][forces < 0 ? 1 : forces + 1];
    for (int k = 0; k < K; ++k) {
        const int at = i + k * N;
        a[k] = hn::LoadU(d, m.a + at);
        b[k] = hn::LoadU(d, m.b + at);
        if constexpr (forces > 0)
            for (int f = 0; f < forces; ++f) g[k][f] = hn::LoadU(d, m.gains[f] + at);
    }
    const auto pushed = [&](int k, int n) {
        V f = hn::Set(d, m.base_moments[n]);
        for (int j = 0; j < count; ++j) {
            const V moment = hn::Set(d, m.moments[j][n]);
            if constexpr (forces > 0) f = hn::MulAdd(g[k][j], moment, f);
            else f = hn::MulAdd(hn::LoadU(d, m.gains[j] + i + k * N), moment, f);
        }
        return f;
    };
    const int terms = m.terms[i / sweep_lanes];
    for (int k = 0; k < K; ++k) {
        Y[k] = pushed(k, terms - 1);
        U[k] = hn::NegMulAdd(a[k], Y[k], pushed(k, terms - 2));
    }
    for (int n = terms - 3; n >= 0; --n)
        for (int k = 0; k < K; ++k) {
            const V next = hn::NegMulAdd(a[k], U[k], hn::NegMulAdd(b[k], Y[k], pushed(k, n)));
            Y[k] = U[k];
            U[k] = next;
        }
    for (int k = 0; k < K; ++k) {
        const int at = i + k * N;
        const V y = hn::LoadU(d, m.y + at), u = hn::LoadU(d, m.u + at),
                base = hn::LoadU(d, m.base + at);
        const auto end = [&](const double* of_y, const double* of_u, V by_forces) {
            return hn::MulAdd(
                base, by_forces,
                hn::MulAdd(hn::LoadU(d, of_y + at), y, hn::Mul(hn::LoadU(d, of_u + at), u)));
        };
        hn::StoreU(end(m.e11, m.e12, Y[k]), d, m.y_out + at);
        hn::StoreU(end(m.e21, m.e22, U[k]), d, m.u_out + at);
    }
}
template <int forces>
void move_under(const ModalSweep& m) {
    const int N = static_cast<int>(hn::Lanes(D()));
    int i = 0;
    for (; i + 4 * N <= m.modes; i += 4 * N) move_block<forces, 4>(m, i);
    for (; i < m.modes; i += N) move_block<forces, 1>(m, i);
}
void move(const ModalSweep& m) {
    switch (m.forces) {
        case 0: return move_under<0>(m);
        case 1: return move_under<1>(m);
        case 2: return move_under<2>(m);
        case 3: return move_under<3>(m);
        case 4: return move_under<4>(m);
        default: return move_under<-1>(m);
    }
}

// In a convolution, step -1, row j begins at out[j]: only zeros lie before it, and whole vectors of
// zeros are left out.
template <int vectors, bool convolution, bool fresh>
void combine_in(double* HWY_RESTRICT out, const double* HWY_RESTRICT x, int count, const double* A,
                long step) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    V even[vectors], odd[vectors];
    for (int v = 0; v < vectors; ++v) {
        even[v] = fresh ? hn::Zero(d) : hn::LoadU(d, out + v * N);
        odd[v] = hn::Zero(d);
    }
    int j = 0;
    const auto rows = [&](auto first, int until) {
        for (; j + 1 < until; j += 2) {
            const V x0 = hn::Set(d, x[j]), x1 = hn::Set(d, x[j + 1]);
            for (int v = first; v < vectors; ++v) {
                even[v] = hn::MulAdd(x0, hn::LoadU(d, A + j * step + v * N), even[v]);
                odd[v] = hn::MulAdd(x1, hn::LoadU(d, A + (j + 1) * step + v * N), odd[v]);
            }
        }
        if (j < until) {
            for (int v = first; v < vectors; ++v)
                even[v] = hn::MulAdd(hn::Set(d, x[j]), hn::LoadU(d, A + j * step + v * N), even[v]);
            ++j;
        }
    };
    if constexpr (convolution && vectors > 1) {
        const auto from = [&](auto first) {
            if constexpr (first.value < vectors) rows(first, HWY_MIN(count, (first.value + 1) * N));
        };
        from(std::integral_constant<int, 0>());
        from(std::integral_constant<int, 1>());
        from(std::integral_constant<int, 2>());
        from(std::integral_constant<int, 3>());
    } else {
        rows(std::integral_constant<int, 0>(), count);
    }
    for (int v = 0; v < vectors; ++v) hn::StoreU(hn::Add(even[v], odd[v]), d, out + v * N);
}
template <bool fresh>
HWY_INLINE void combine_into(double* out, int size, const double* x, int count, const double* A,
                             long step) {
    const int N = static_cast<int>(hn::Lanes(D()));
    if (step == -1 && size <= 4 * N) {
        if (size == 4 * N) return combine_in<4, true, fresh>(out, x, count, A, -1);
        if (size == 3 * N) return combine_in<3, true, fresh>(out, x, count, A, -1);
        if (size == 2 * N) return combine_in<2, true, fresh>(out, x, count, A, -1);
    }
    for (; size >= 4 * N; size -= 4 * N, out += 4 * N, A += 4 * N)
        combine_in<4, false, fresh>(out, x, count, A, step);
    if (size == 3 * N) combine_in<3, false, fresh>(out, x, count, A, step);
    else if (size == 2 * N) combine_in<2, false, fresh>(out, x, count, A, step);
    else if (size == N) combine_in<1, false, fresh>(out, x, count, A, step);
}
void combine(double* out, int size, const double* x, int count, const double* A, long step) {
    if (count == 0) return;  // there may be no A
    combine_into<false>(out, size, x, count, A, step);
}
void combined(double* out, int size, const double* x, int count, const double* A, long step) {
    combine_into<true>(out, size, x, count, A, step);
}

// u^lane; `later` becomes u^N
HWY_INLINE V first_powers(double u, V& later) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    const V lane = hn::Iota(d, 0.0), one = hn::Set(d, 1.0), two = hn::Set(d, 2.0),
            four = hn::Set(d, 4.0), six = hn::Set(d, 6.0);
    const double u2 = u * u, u4 = u2 * u2;
    const auto low = hn::Or(hn::Eq(lane, one), hn::Eq(lane, hn::Set(d, 3.0)));
    const auto odd =
        hn::Or(low, hn::Or(hn::Eq(lane, hn::Set(d, 5.0)), hn::Eq(lane, hn::Set(d, 7.0))));
    const auto second = hn::Or(hn::And(hn::Ge(lane, two), hn::Lt(lane, four)), hn::Ge(lane, six));
    later = hn::Set(d, N == 8 ? u4 * u4 : N == 4 ? u4 : N == 2 ? u2 : u);
    return hn::Mul(hn::IfThenElse(odd, hn::Set(d, u), one),
                   hn::Mul(hn::IfThenElse(second, hn::Set(d, u2), one),
                           hn::IfThenElse(hn::Ge(lane, four), hn::Set(d, u4), one)));
}
void powers(double u, int count, const double* inverse_factorial, double* e) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    V later, power = first_powers(u, later);
    for (int n = 0; n < count; n += N, power = hn::Mul(power, later))
        hn::StoreU(hn::Mul(power, hn::LoadU(d, inverse_factorial + n)), d, e + n);
}

template <int first, int last, bool absolute>
HWY_INLINE void evaluate_at(const double* p, int size, double u, double* out) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    V later, power = first_powers(u, later);
    V sum[last - first];
    for (int k = 0; k < last - first; ++k) sum[k] = hn::Zero(d);
    for (int n = 0; n < size; n += N, power = hn::Mul(power, later)) {
        const V e = hn::Mul(power, hn::LoadU(d, inverse_factorials + n));
        for (int k = 0; k < last - first; ++k) {
            const V x = hn::LoadU(d, p + n + first + k);
            sum[k] = hn::MulAdd(e, absolute ? hn::Abs(x) : x, sum[k]);
        }
    }
    for (int k = 0; k < last - first; ++k) out[k] = hn::GetLane(hn::SumOfLanes(d, sum[k]));
}
void evaluate(const double* p, int size, double u, double* out) {
    evaluate_at<0, 3, false>(p, size, u, out);
}
void bound(const double* p, int size, double u, double* out) {
    evaluate_at<2, 4, true>(p, size, u, out);
}

void range(const double* p, const double* bernstein, int size, double u, double* out) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    HWY_ALIGN double x[32], b[32] = {};
    V later, power = first_powers(u, later);
    for (int n = 0; n < size; n += N, power = hn::Mul(power, later))
        hn::Store(hn::Mul(power, hn::LoadU(d, p + n)), d, x + n);
    combine_into<true>(b, size, x, size, bernstein, size);
    V least = hn::Load(d, b), most = least;
    for (int n = N; n < size; n += N) {
        least = hn::Min(least, hn::Load(d, b + n));
        most = hn::Max(most, hn::Load(d, b + n));
    }
    out[0] = hn::GetLane(hn::MinOfLanes(d, least));
    out[1] = hn::GetLane(hn::MaxOfLanes(d, most));
}

void subtract(double* to, double f, const double* column, int from, int size) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    const V factor = hn::Set(d, f);
    for (int i = from; i < size; i += N)
        hn::StoreU(hn::NegMulAdd(factor, hn::LoadU(d, column + i), hn::LoadU(d, to + i)), d,
                   to + i);
}
// Factors eight columns at a time: first among themselves, then each following column, which is
// read and written once for all eight.
void factor(double* matrix, double* column, int size) {
    constexpr int block = 8;
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    using Lane = decltype(hn::SetTableIndices(d, static_cast<const int64_t*>(nullptr)));
    Lane every[block];  // a lane everywhere
    for (int k = 0; k < N; ++k) {
        HWY_ALIGN int64_t index[block];
        for (int i = 0; i < block; ++i) index[i] = k;
        every[k] = hn::SetTableIndices(d, index);
    }
    // their factors in their own rows, zero up to the diagonal [column][row]
    HWY_ALIGN double low[block * block];
    for (int first = 0; first < size; first += block) {
        double* HWY_RESTRICT panel = matrix + static_cast<long>(first) * size;
        for (int c = first; c < first + block; ++c) {
            double* pivot = matrix + static_cast<long>(c) * size;
            const int from = c / N * N;
            const double inverse = 1 / pivot[c];
            for (int i = from; i <= c; ++i) column[i] = 0;  // rows up to c stay
            for (int i = c + 1; i < size; ++i) column[i] = pivot[i] *= inverse;
            for (int j = c + 1; j < first + block; ++j)
                subtract(matrix + static_cast<long>(j) * size,
                         matrix[static_cast<long>(j) * size + c], column, from, size);
            for (int i = 0; i < block; ++i)
                low[(c - first) * block + i] = first + i > c ? pivot[first + i] : 0;
        }
        for (int j = first + block; j < size; ++j) {
            double* HWY_RESTRICT to = matrix + static_cast<long>(j) * size;
            V f[block], own[block];
            for (int v = 0; v < block / N; ++v) own[v] = hn::LoadU(d, to + first + v * N);
            for (int k = 0; k < block; ++k) {
                f[k] = hn::TableLookupLanes(own[k / N], every[k % N]);
                for (int v = k / N; v < block / N; ++v)
                    own[v] = hn::NegMulAdd(f[k], hn::Load(d, low + k * block + v * N), own[v]);
            }
            for (int v = 0; v < block / N; ++v) hn::StoreU(own[v], d, to + first + v * N);
            for (int i = first + block; i < size; i += N) {
                V x = hn::LoadU(d, to + i);
                for (int k = 0; k < block; ++k)
                    x = hn::NegMulAdd(f[k], hn::LoadU(d, panel + static_cast<long>(k) * size + i),
                                      x);
                hn::StoreU(x, d, to + i);
            }
        }
    }
}
void substitute(const double* matrix, double* right, double* x, int size) {
    const int N = static_cast<int>(hn::Lanes(D()));
    for (int c = 0; c < size; ++c) {
        const double* pivot = matrix + static_cast<long>(c) * size;
        int i = c + 1;
        for (; i < size && i % N != 0; ++i) right[i] -= right[c] * pivot[i];
        subtract(right, right[c], pivot, i, size);
    }
    for (int c = size - 1; c >= 0; --c) {
        const double* pivot = matrix + static_cast<long>(c) * size;
        // right[c] and the rest of its vector are no longer needed
        x[c] = right[c] / pivot[c];
        subtract(right, x[c], pivot, 0, c);
    }
    for (int i = 0; i < size; ++i) right[i] = x[i];
}

void scale_rows(double* out, const double* row, const double* A, const double* row2,
                const double* A2, int size) {
    const D d;
    const int N = static_cast<int>(hn::Lanes(d));
    for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; i += N) {
            const long at = static_cast<long>(j) * size + i;
            V x = hn::Mul(hn::LoadU(d, row + i), hn::LoadU(d, A + at));
            if (A2) x = hn::MulAdd(hn::LoadU(d, row2 + i), hn::LoadU(d, A2 + at), x);
            hn::StoreU(x, d, out + at);
        }
        out[static_cast<long>(j) * size + j] += 1;
    }
}

const SweepFunctions* functions() {
    static constexpr SweepFunctions table = {read,  move,  combine, combined,   powers,    evaluate,
                                             bound, range, factor,  substitute, scale_rows};
    return &table;
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(functions);
const SweepFunctions& sweep_functions() {
    static const SweepFunctions* chosen = HWY_DYNAMIC_DISPATCH(functions)();
    return *chosen;
}
}  // namespace jvari
#endif
