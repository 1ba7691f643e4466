// Builds a touching set, in long double.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "reference/exact/macro_window.hpp"
#include "reference/exact/touching_set.hpp"
#include "schemes/decompositions.hpp"

namespace jvari {

namespace {
using LongReal = long double;
using LongComplex = std::complex<LongReal>;
using LongMatrix = Eigen::Matrix<LongReal, Eigen::Dynamic, Eigen::Dynamic>;
using LongComplexMatrix = Eigen::Matrix<LongComplex, Eigen::Dynamic, Eigen::Dynamic>;

std::span<const LongReal> numbers(const LongMatrix& m) {
    return {m.data(), static_cast<std::size_t>(m.size())};
}
LongMatrix inverse(const LongMatrix& m) {
    return LongMatrix::Map(inverse_of(numbers(m), static_cast<int>(m.rows())).data(), m.rows(),
                           m.cols());
}

// radians per window of a contact alone, and the slowest motion that is split off
constexpr LongReal stiff = 12, least = 10;
constexpr LongReal most_spans = 100;  // in windows
// growth of a soft set: e^9 last bits reach the tolerances here
constexpr LongReal longest_span = 9;
constexpr int resolvent_terms = 72;  // 9^72/72! is nothing

// x^n, n < `powers`, on [0, 1] as polynomials with degree N - 1 by their Chebyshev series:
// coefficients of x^i [i][n]. x^n = 2^(1 - 2n) (C(2n, n)/2 + sum_k C(2n, n - k) T_k(2x - 1)). Up to
// n = N - 1 nothing changes.
LongMatrix economised(int N, int powers) {
    // T_k(2x - 1) = (4x - 2) T_(k-1) - T_(k-2) [i][k]
    LongMatrix T = LongMatrix::Zero(N, N), out = LongMatrix::Identity(N, powers);
    T(0, 0) = 1;
    if (N > 1) T(0, 1) = -1, T(1, 1) = 2;
    for (int k = 2; k < N; ++k)
        for (int i = 0; i <= k; ++i)
            T(i, k) = (i > 0 ? 4 * T(i - 1, k - 1) : 0) - 2 * T(i, k - 1) - T(i, k - 2);
    for (int n = N; n < powers; ++n) {
        LongReal c = 1;  // C(2n, n)/4^n
        for (int i = 1; i <= n; ++i) c *= static_cast<LongReal>(2 * i - 1) / (2 * i);
        for (int k = 0; k < N; ++k) {
            out.col(n) += (k == 0 ? c : 2 * c) * T.col(k);
            c *= static_cast<LongReal>(n - k) / (n + k + 1);
        }
    }
    return out;
}
}  // namespace

struct TouchingSet::Operator {  // H_j K
    std::vector<LongMatrix> A;
    int points() const { return static_cast<int>(A.front().rows()); }
    int terms() const { return static_cast<int>(A.size()); }
    bool pushes_at_once() const { return !A[0].isZero(0); }
};

namespace {
// Fast invariant subspace: (p, ..., p^(order - 1))' = L (p, ..., p^(order - 1)) with I^i p = [1 0]
// L^-i (p, ...). Empty if no part is so much faster than the others.
LongMatrix fast_part(const std::vector<LongMatrix>& A, int order) {
    const long P = A.front().rows();
    LongMatrix first = LongMatrix::Zero(order * P, order * P);
    if (order == 2) first.topRightCorner(P, P).setIdentity();
    for (int j = 0; j < order; ++j) first.block((order - 1) * P, (order - 1 - j) * P, P, P) = -A[j];
    LongMatrix L = first;
    LongReal change = 1;
    for (int i = 0; i < 200 && change >= 1e-18L; ++i) {
        const LongMatrix inverted = inverse(L);
        LongMatrix next = first, power = inverted;
        for (std::size_t j = order; j < A.size(); ++j, power = power.lazyProduct(inverted).eval())
            next.bottomRows(P) -= A[j].lazyProduct(power.topRows(P));
        change = (next - L).norm() / L.norm();
        L = next;
    }
    return change < 1e-15L ? L : LongMatrix();
}

struct FastMotion {  // pairs as rates, one of two conjugates, and unit shapes in columns
    std::vector<LongComplex> rates;
    LongComplexMatrix v;
};
// Empty if a rate grows or is slower than `slowest`.
FastMotion fast_motion(const LongMatrix& L, int P, LongReal slowest) {
    const int all = static_cast<int>(L.rows());
    const Eigenpairs pairs = eigenpairs_of(numbers(L), all);
    FastMotion fast{{}, LongComplexMatrix(P, all)};
    for (int k = 0; k < all; ++k) {
        const LongComplex rate = pairs.value[k];
        if (rate.real() > 0 || std::abs(rate) < slowest) return {};
        if (rate.imag() < 0) continue;
        const int now = static_cast<int>(fast.rates.size());
        for (int a = 0; a < P; ++a) fast.v(a, now) = pairs.vector[all * k + a];
        fast.v.col(now) /= fast.v.col(now).norm();
        fast.rates.push_back(rate);
    }
    return fast;
}

// G: rows and columns [derivative][point]. Inverted in a unit of time that divides the slow part's
// growth by `growth`. A part that grows fast would lose its digits otherwise.
LongMatrix slow_inverse(const std::vector<LongMatrix>& A, int order, LongReal growth) {
    const int P = static_cast<int>(A.front().rows()), N = static_cast<int>(A.size());
    LongMatrix operation = LongMatrix::Zero(P * N, P * N);
    for (int n = 0; n < N; ++n) {
        if (n + order < N)
            operation.block(n * P, (n + order) * P, P, P)
                .diagonal()
                .setConstant(std::pow(growth, LongReal(order)));
        for (int j = std::max(0, n + order - N); j < std::min(n + order, N); ++j)
            operation.block(n * P, (n + order - 1 - j) * P, P, P) +=
                A[j] * std::pow(growth, LongReal(order - 1 - j));
    }
    LongMatrix G = inverse(operation);
    for (int n = 0; n < N; ++n)
        for (int m = 0; m < N; ++m)
            G.block(n * P, m * P, P, P) *= std::pow(growth, LongReal(n - m));
    return G;
}
// Growth of the slow part under a steady push.
LongReal growth_of(const LongMatrix& G, int P, int N) {
    LongReal growth = 0;
    for (int n = N / 2; n + 1 < N; ++n)
        growth =
            std::max(growth, std::pow(G.block(n * P, 0, P, P).norm() / G.topLeftCorner(P, P).norm(),
                                      LongReal(1) / n));
    return growth;
}
// Re beta, and -Im beta for oscillating pairs -> p(0) and, if order is 2, p'(0)
LongMatrix start_of(const FastMotion& fast, const LongComplexMatrix& Q, int P, int order) {
    LongMatrix start(order * P, order * P);
    int column = 0;
    for (std::size_t k = 0; k < fast.rates.size(); ++k, ++column) {
        const bool oscillates = fast.rates[k].imag() != 0;
        LongComplexMatrix here = fast.v.col(k);
        for (int d = 0; d < order; ++d, here *= fast.rates[k]) {
            const LongComplexMatrix all = here + Q.block(d * P, k, P, 1);
            start.block(d * P, column, P, 1) = all.real();
            if (oscillates) start.block(d * P, column + 1, P, 1) = -all.imag();
        }
        if (oscillates) ++column;
    }
    return start;
}
}  // namespace

struct TouchingSet::Split {
    FastMotion fast;
    LongComplexMatrix Q;  // contribution to the slow part [derivative and point][pair]
};

TouchingSet::TouchingSet(const MacroWindow& w, std::span<const int> points,
                         std::span<const double> stiffness)
    : window_(&w), points_(points.begin(), points.end()), k_(stiffness.begin(), stiffness.end()) {
    const int P = static_cast<int>(points_.size()), N = w.terms;
    Operator H{std::vector<LongMatrix>(N, LongMatrix::Zero(P, P))};
    for (int j = 0; j < N; ++j)
        for (int a = 0; a < P; ++a)
            for (int b = 0; b < P; ++b)
                H.A[j](a, b) = static_cast<LongReal>(w.kernel(points_[a], points_[b])[j]) * k_[b];
    LongMatrix symmetric(P, P);
    // squared radians; a decay must be equally fast
    const LongMatrix squares = H.pushes_at_once() ? LongMatrix(H.A[0] * stiff) : H.A[1];
    for (int a = 0; a < P; ++a)
        for (int b = 0; b < P; ++b)
            symmetric(a, b) = squares(a, b) * std::sqrt(static_cast<LongReal>(k_[a]) / k_[b]);
    const Eigen::MatrixXd even = ((symmetric + symmetric.transpose()) / 2).cast<double>();
    const double softest = symmetric_parts(std::span(even.data(), even.size()), P).value.front();
    if (!(softest > stiff * stiff)) soften();
    else if (!split(H, 2) && H.pushes_at_once()) split(H, 1);
}

bool TouchingSet::split(const Operator& H, int order) {
    const std::vector<LongMatrix>& A = H.A;
    const int P = H.points(), N = H.terms();
    const LongMatrix L = fast_part(A, order);
    if (L.size() == 0) return false;
    const LongReal reach = window_->reach,
                   about = order == 2 ? 1 : std::max(reach, A[1].norm() / A[0].norm());
    const LongMatrix G = slow_inverse(A, order, about);
    const LongReal growth = order == 2 ? reach : std::max(reach, growth_of(G, P, N));
    const FastMotion fast = fast_motion(L, P, least * growth / reach);
    if (fast.rates.empty() || !(growth < most_spans * reach)) return false;
    const int E = pairs_ = static_cast<int>(fast.rates.size());
    order_ = order;
    growth_ = static_cast<double>(growth);
    span_ = static_cast<double>(reach / growth);

    LongComplexMatrix q = LongComplexMatrix::Zero(P * N, E);
    for (int k = 0; k < E; ++k)
        for (int n = 0; n < N; ++n) {
            LongComplex power = LongComplex(1) / fast.rates[k];
            for (int j = n + order; j < N; ++j, power /= fast.rates[k])
                q.block(n * P, k, P, 1) += A[j].lazyProduct(fast.v.col(k)) * power;
        }
    const LongComplexMatrix Q = G.lazyProduct(q);

    const LongMatrix started = inverse(start_of(fast, Q, P, order));

    for (const LongComplex& rate : fast.rates)
        rate_.push_back(static_cast<std::complex<double>>(rate));
    beta_.assign(2 * E, 0.0);
    for (int b = 0; b < P; ++b) pushed_at_once_.push_back(static_cast<double>(A[0](b, b)));
    start_.assign(static_cast<std::size_t>(2 * E) * 2 * P, 0.0);
    for (int k = 0, row = 0; k < E; ++k)
        for (int part = 0; part < (fast.rates[k].imag() != 0 ? 2 : 1); ++part, ++row)
            for (int j = 0; j < order * P; ++j)
                start_[(2 * k + part) * 2 * P + j] = static_cast<double>(started(row, j));
    const int size = window_->size;
    inverse_.assign(static_cast<std::size_t>(P) * N * P * size, 0.0);
    for (int m = 0; m + order < N; ++m)
        for (int b = 0; b < P; ++b)
            for (int a = 0; a < P; ++a)
                for (int n = 0; n < N; ++n)
                    inverse_[(static_cast<std::size_t>(m * P + b) * P + a) * size + n] =
                        static_cast<double>(G(n * P + a, m * P + b));
    put_pairs({fast, Q});
    return true;
}

// Shapes, and contributions to the slow part, at every contact.
void TouchingSet::put_pairs(const Split& s) {
    const MacroWindow& w = *window_;
    const auto& [rates, v] = s.fast;
    const int P = static_cast<int>(points_.size()), N = w.terms, size = w.size, E = pairs_;
    shape_.assign(static_cast<std::size_t>(w.contacts) * E, 0.0);
    slow_.assign(static_cast<std::size_t>(E) * w.contacts * 2 * size, 0.0);
    for (int k = 0; k < E; ++k)
        for (int a = 0; a < w.contacts; ++a) {
            const auto touching = std::find(points_.begin(), points_.end(), a);
            double* slow = slow_.data() + (static_cast<std::size_t>(a) * E + k) * 2 * size;
            const auto add = [&](int n, LongComplex x) {
                slow[n] += static_cast<double>(x.real());
                slow[size + n] += static_cast<double>(x.imag());
            };
            if (touching != points_.end()) {
                const int at = static_cast<int>(touching - points_.begin());
                shape_[a * E + k] = static_cast<std::complex<double>>(v(at, k));
                for (int n = 0; n < N; ++n) add(n, s.Q(n * P + at, k));
                continue;
            }
            // -sum_b k_b v_b sum_j h_j lambda^(-j-1) for e^(lambda u), and the powers that I^(j+1)
            // leaves
            LongComplex sum = 0;
            for (int b = 0; b < P; ++b)
                for (int j = 0; j < N; ++j) {
                    const LongComplex part = -static_cast<LongReal>(k_[b]) * v(b, k) *
                                             static_cast<LongReal>(w.kernel(a, points_[b])[j]);
                    sum += part * std::pow(rates[k], static_cast<LongReal>(-j - 1));
                    for (int n = 0; n <= j; ++n)
                        add(n, -part * std::pow(rates[k], static_cast<LongReal>(n - j - 1)));
                }
            shape_[a * E + k] = static_cast<std::complex<double>>(sum);
        }
}

// The resolvent's series R, R_0 = I, R_n = -sum_j H_j K R_(n-1-j), followed by the response of
// points that do not touch. p_n = sum R_(n-m) r_m goes on beyond the end of r. A series cut there
// would reach to the limit of its growth; the best polynomial with equally many terms reaches four
// times farther.
void TouchingSet::soften() noexcept {
    const MacroWindow& w = *window_;
    const int P = static_cast<int>(points_.size()), N = w.terms;
    std::vector<LongMatrix> R(resolvent_terms, LongMatrix::Zero(w.contacts, P));
    for (int b = 0; b < P; ++b) R[0](points_[b], b) = 1;
    LongReal growth = w.reach;
    for (int n = 1; n < resolvent_terms; ++n) {
        for (int j = 0; j < std::min(n, N); ++j)
            for (int a = 0; a < w.contacts; ++a)
                for (int b = 0; b < P; ++b)
                    R[n].row(a) -= static_cast<LongReal>(w.kernel(a, points_[b])[j]) * k_[b] *
                                   R[n - 1 - j].row(points_[b]);
        if (n >= N / 2 && n < N) growth = std::max(growth, std::pow(R[n].norm(), LongReal(1) / n));
    }
    growth_ = static_cast<double>(growth);
    const LongReal span =
        std::min<LongReal>(1, std::min<LongReal>(3 * w.reach, longest_span) / growth);
    span_ = static_cast<double>(span);
    if (growth > most_spans * w.reach) return;
    LongMatrix shorter = economised(N, resolvent_terms);  // derivatives over the span
    for (int n = N; n < resolvent_terms; ++n)
        for (int i = 0; i < N; ++i)
            shorter(i, n) *= std::exp(std::lgamma(i + LongReal(1)) - std::lgamma(n + LongReal(1))) *
                             std::pow(span, n - i);
    resolvent_.assign(static_cast<std::size_t>(w.contacts) * P * N * w.size, 0.0);
    for (int a = 0; a < w.contacts; ++a)
        for (int b = 0; b < P; ++b)
            for (int m = 0; m < N; ++m)
                for (int i = 0; i < N; ++i) {
                    LongReal sum = i >= m ? R[i - m](a, b) : LongReal(0);
                    for (int n = N; n < resolvent_terms; ++n) sum += shorter(i, n) * R[n - m](a, b);
                    resolvent_[((static_cast<std::size_t>(a) * P + b) * N + m) * w.size + i] =
                        static_cast<double>(sum);
                }
}

}  // namespace jvari
