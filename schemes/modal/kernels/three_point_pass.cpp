// Modal recursion and synthesis at the reads alone, one pass over the modes per step   (Issanchou
// et al. 2016, eq 14).
//
// Layout: modes j and N-j stand in pairs, level = [lo | hi] with lo = modes 1 .. H, hi = modes N-1
// .. N-H, each padded with zeros. On a node sin(i(N-j) pi/N) = -(-1)^i sin(ij pi/N), so a pair
// shares one weight and enters by lo + hi on odd nodes, lo - hi on even ones. Weights for a run of
// consecutive nodes come from two loads by sin((i+2)a) = 2cos(2a) sin(ia) - sin((i-2)a) in
// registers; their sums stay in registers. For even N the middle mode is its own partner: the place
// opposite holds C~ = 0, kappa = 1, so that a force pushed into it reads 0.
//
// Vector instructions are chosen at run time (Highway); the order of summation, so the last digits,
// depends on the machine.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/three_point_pass.cpp"
#ifndef HWY_DISABLED_TARGETS
// vectors with unknown size make no arrays
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#include <hwy/foreach_target.h>  // NOLINT: must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "schemes/modal/kernels/three_point_pass.hpp"

#ifndef JVARI_THREE_POINT_PASS
#define JVARI_THREE_POINT_PASS
namespace jvari {

struct Push {  // a port that is pushed in this step
    const double* lo;
    const double* hi;
    double to_lo, to_hi;  // dt^2/m F, with the node's sign on hi
};
struct NodeRun {            // consecutive nodes
    int first, count, out;  // places of its first read in Pass::line and Pass::free
    double sign;            // +1 if its first node is odd, otherwise -1
};
struct Pass {
    const double *Ct, *kappa, *twocos;
    double *y, *d;
    long half;  // padded length of lo and of hi
    const Push* push;
    int pushes;
    const double* const* line;  // [lo | hi] weights for every read
    const NodeRun* run;
    int runs;
    int lines;
    double* free;  // one per line
};

}  // namespace jvari
#endif

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

// Sums that fit in the registers beside the eight values that a pair of modes needs.
constexpr int most_sums = HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86 ? 20 : 8;

HWY_INLINE double total(V x) { return hn::GetLane(hn::SumOfLanes(D(), x)); }

// Adds to sum[k] the displacement at node first + k: a = lo + sign hi, b = lo - sign hi.
template <int K>
HWY_INLINE void synthesise(const Pass& p, const double* s0, const double* s1, long v, V a, V b,
                           V* sum) {
    const D tag;
    const V first = hn::Load(tag, s0 + v);
    sum[0] = hn::MulAdd(first, a, sum[0]);
    if constexpr (K > 1) {
        const V second = hn::Load(tag, s1 + v);
        sum[1] = hn::MulAdd(second, b, sum[1]);
        if constexpr (K > 2) {
            const V c = hn::Load(tag, p.twocos + v);  // 2 cos a
            V even0 = first, odd0 = second, even = hn::MulSub(c, second, first),
              odd = hn::MulSub(c, even, second);
            const V c2 = hn::MulSub(c, c, hn::Set(tag, 2.0));  // 2 cos 2a
            sum[2] = hn::MulAdd(even, a, sum[2]);
            if constexpr (K > 3) sum[3] = hn::MulAdd(odd, b, sum[3]);
            HWY_UNROLL(10)
            for (int k = 4; k < K; k += 2) {
                const V e = hn::MulSub(c2, even, even0), o = hn::MulSub(c2, odd, odd0);
                even0 = even, even = e, odd0 = odd, odd = o;
                sum[k] = hn::MulAdd(e, a, sum[k]);
                if (k + 1 < K) sum[k + 1] = hn::MulAdd(o, b, sum[k + 1]);
            }
        }
    }
}

// Forces pushed in this step: the first two ports' parts stay in registers, further ports (a long
// contact, a pluck) are looped over.
template <int pushes>  // 0, 1, 2, or 3 for more
struct Pushed {
    static constexpr int kept = pushes < 2 ? pushes : 2;
    const double *lo[kept + 1], *hi[kept + 1];
    V to_lo[kept + 1], to_hi[kept + 1];
    HWY_INLINE explicit Pushed(const Pass& p) {
        for (int k = 0; k < kept; ++k) {
            lo[k] = p.push[k].lo, hi[k] = p.push[k].hi;
            to_lo[k] = hn::Set(D(), p.push[k].to_lo), to_hi[k] = hn::Set(D(), p.push[k].to_hi);
        }
    }
};

// Makes the step itself on the pair of vectors at v; returns y + d for lo and hi.
struct Pair {
    V lo, hi;
};
template <int pushes>
HWY_INLINE Pair update(const Pass& p, const Pushed<pushes>& pushed, long v) {
    const D tag;
    double *ylo = p.y + v, *yhi = ylo + p.half, *dlo = p.d + v, *dhi = dlo + p.half;
    V a = hn::Load(tag, dlo), b = hn::Load(tag, dhi);
    for (int k = 0; k < pushed.kept; ++k) {
        a = hn::MulAdd(hn::Load(tag, pushed.lo[k] + v), pushed.to_lo[k], a);
        b = hn::MulAdd(hn::Load(tag, pushed.hi[k] + v), pushed.to_hi[k], b);
    }
    if constexpr (pushes > 2) {
        for (int k = 2; k < p.pushes; ++k) {
            const Push& push = p.push[k];
            a = hn::MulAdd(hn::Load(tag, push.lo + v), hn::Set(tag, push.to_lo), a);
            b = hn::MulAdd(hn::Load(tag, push.hi + v), hn::Set(tag, push.to_hi), b);
        }
    }
    const V y = hn::Add(hn::Load(tag, ylo), a), z = hn::Add(hn::Load(tag, yhi), b);
    a = hn::NegMulAdd(hn::Load(tag, p.kappa + v), y, hn::Mul(hn::Load(tag, p.Ct + v), a));
    b = hn::NegMulAdd(hn::Load(tag, p.kappa + p.half + v), z,
                      hn::Mul(hn::Load(tag, p.Ct + p.half + v), b));
    hn::Store(y, tag, ylo);
    hn::Store(z, tag, yhi);
    hn::Store(a, tag, dlo);
    hn::Store(b, tag, dhi);
    return {hn::Add(y, a), hn::Add(z, b)};
}
HWY_INLINE Pair reread(const Pass& p, long v) {
    const D tag;
    return {hn::Add(hn::Load(tag, p.y + v), hn::Load(tag, p.d + v)),
            hn::Add(hn::Load(tag, p.y + p.half + v), hn::Load(tag, p.d + p.half + v))};
}

constexpr int no_step = -1;  // in place of pushes: the update has happened in an earlier pass

// K nodes from place `first` in the reads; `pushes` has the meaning in Pushed.
template <int K, int pushes>
void nodes(const Pass& pass, int first, int count, int out, double sign) {
    const Pass p = pass;  // a copy that no store can alias: its members stay in registers
    const D tag;
    const long lanes = static_cast<long>(hn::Lanes(tag));
    const double *s0 = p.line[first], *s1 = p.line[first + (count > 1 ? 1 : 0)];
    const Pushed<std::max(pushes, 0)> pushed(p);
    const V way = hn::Set(tag, sign);
    V sum[K];
    for (int k = 0; k < K; ++k) sum[k] = hn::Zero(tag);
    for (long v = 0; v < p.half; v += lanes) {
        Pair x;
        if constexpr (pushes == no_step) x = reread(p, v);
        else x = update(p, pushed, v);
        synthesise<K>(p, s0, s1, v, hn::MulAdd(way, x.hi, x.lo), hn::NegMulAdd(way, x.hi, x.lo),
                      sum);
    }
    for (int k = 0; k < K; ++k)
        if (k < count) p.free[out + k] = total(sum[k]);
}

template <int pushes, int K = most_sums>
// uses the least sufficient K, even or 1
void chunk(const Pass& p, int first, int count, int out, double sign) {
    if constexpr (K > 2)
        if (count <= K - 2) return chunk<pushes, K - 2>(p, first, count, out, sign);
    if (count == 1) return nodes<1, pushes>(p, first, count, out, sign);
    nodes<K, pushes>(p, first, count, out, sign);
}

// K reads from place `first`, with separate weights on lo and hi.
template <int K, int pushes>
void lines(const Pass& pass, int first, int count) {
    const Pass p = pass;
    const D tag;
    const long lanes = static_cast<long>(hn::Lanes(tag));
    const Pushed<std::max(pushes, 0)> pushed(p);
    const double* line[K + 1];
    for (int k = 0; k < K; ++k) line[k] = p.line[first + std::min(k, count - 1)];
    V sum[2 * K + 1];
    for (V& s : sum) s = hn::Zero(tag);
    for (long v = 0; v < p.half; v += lanes) {
        Pair x;
        if constexpr (pushes == no_step) x = reread(p, v);
        else x = update(p, pushed, v);
        for (int k = 0; k < K; ++k) {
            sum[2 * k] = hn::MulAdd(hn::Load(tag, line[k] + v), x.lo, sum[2 * k]);
            sum[2 * k + 1] = hn::MulAdd(hn::Load(tag, line[k] + p.half + v), x.hi, sum[2 * k + 1]);
        }
    }
    for (int k = 0; k < K; ++k)
        if (k < count) p.free[first + k] = total(hn::Add(sum[2 * k], sum[2 * k + 1]));
}

constexpr int most_lines = 4;

template <int pushes>
void some_lines(const Pass& p, int first, int count) {
    if (count > 2) return lines<most_lines, pushes>(p, first, count);
    if (count > 1) return lines<2, pushes>(p, first, count);
    lines<1, pushes>(p, first, count);
}

template <int pushes>
void advance_with(const Pass& p) {
    if (p.lines == 0) return lines<0, pushes>(p, 0, 0);
    for (int k = 0; p.runs == 0 && k < p.lines; k += most_lines) {
        const int count = std::min(p.lines - k, most_lines);
        if (k > 0) some_lines<no_step>(p, k, count);
        else some_lines<pushes>(p, k, count);
    }
    for (int r = 0; r < p.runs; ++r) {
        const NodeRun& run = p.run[r];
        // most_sums is even: each chunk starts on the same parity
        for (int k = 0; k < run.count; k += most_sums) {
            const int count = std::min(run.count - k, most_sums);
            if (r + k > 0) chunk<no_step>(p, run.first + k, count, run.out + k, run.sign);
            else chunk<pushes>(p, run.first + k, count, run.out + k, run.sign);
        }
    }
}

void advance(const Pass& p) {
    switch (p.pushes) {
        case 0: return advance_with<0>(p);
        case 1: return advance_with<1>(p);
        case 2: return advance_with<2>(p);
        default: return advance_with<3>(p);
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>
#include <numbers>

namespace jvari {

namespace {
HWY_EXPORT(advance);
constexpr int pad = 8;  // doubles in the widest vector
}  // namespace

struct ThreePointPass::Plan {
    LinearUpdate update;
    int half;                            // H
    std::vector<AlignedVector> weights;  // for each port, [lo | hi]
    // push weights over gain; none if they equal the read weights
    std::vector<AlignedVector> pushed;
    std::vector<int> port;            // for each read in the order of the pass
    std::vector<const double*> line;  // weights of the read
    std::vector<NodeRun> runs;
    std::vector<Push> push;
    AlignedVector Ct, kappa, twocos;
    std::vector<double> free;
    long padded = 0;

    long place(int mode) const {
        return mode <= half ? mode - 1 : padded + update.intervals - mode - 1;
    }
};

ThreePointPass::ThreePointPass(const LinearUpdate& update) : plan_(std::make_unique<Plan>()) {
    Plan& p = *plan_;
    p.update = update;
    const int N = update.intervals;
    p.half = N / 2;
    p.padded = (p.half + pad - 1) / pad * pad;
    p.Ct = AlignedVector(2 * p.padded);
    p.kappa = AlignedVector(2 * p.padded);
    p.twocos = AlignedVector(p.padded);
    std::fill_n(p.kappa.data(), 2 * p.padded, 1.0);
    for (int j = 1; j < N; ++j) {
        p.Ct.data()[p.place(j)] = update.Ct[j - 1];
        p.kappa.data()[p.place(j)] = update.kappa[j - 1];
    }
    for (int j = 1; j <= p.half; ++j)
        p.twocos.data()[j - 1] = 2 * std::cos(std::numbers::pi * j / N);
    for (const Port& port : update.ports) p.weights.push_back(reading(port.weights));
    for (const Port& port : update.ports) {
        if (update.over_plain.empty()) break;
        std::vector<double> e = port.weights;
        for (std::size_t j = 0; j < e.size(); ++j) e[j] *= update.over_plain[j];
        p.pushed.push_back(reading(e));
    }
    p.push.resize(update.ports.size());

    for (int z = 0; z < update.reads; ++z) p.port.push_back(z);
    const bool all_nodes =
        std::all_of(p.port.begin(), p.port.end(), [&](int z) { return update.ports[z].node != 0; });
    const auto node = [&](int z) { return update.ports[z].node; };
    if (all_nodes)
        std::sort(p.port.begin(), p.port.end(), [&](int a, int b) { return node(a) < node(b); });
    for (int k = 0; k < update.reads; ++k) {
        p.line.push_back(p.weights[p.port[k]].data());
        if (!all_nodes) continue;
        if (!p.runs.empty() && node(p.port[k]) == node(p.port[k - 1]) + 1) ++p.runs.back().count;
        else p.runs.push_back({k, 1, k, node(p.port[k]) % 2 == 1 ? 1.0 : -1.0});
    }
    p.free.assign(update.reads + 1, 0.0);
    levels.displacement = AlignedVector(2 * p.padded);
    levels.increment = AlignedVector(2 * p.padded);
}
ThreePointPass::~ThreePointPass() = default;

void ThreePointPass::start(const double* y, const double* free_increment) {
    std::fill_n(levels.displacement.data(), levels.displacement.size(), 0.0);
    std::fill_n(levels.increment.data(), levels.increment.size(), 0.0);
    for (int j = 1; j < plan_->update.intervals; ++j) {
        levels.displacement.data()[plan_->place(j)] = y[j - 1];
        levels.increment.data()[plan_->place(j)] = free_increment[j - 1];
    }
}

void ThreePointPass::read(double* free) const {
    for (int z = 0; z < plan_->update.reads; ++z) {
        free[z] = 0;
        for (std::size_t v = 0; v < levels.displacement.size(); ++v)
            free[z] += plan_->weights[z].data()[v] *
                       (levels.displacement.data()[v] + levels.increment.data()[v]);
    }
}

void ThreePointPass::advance(const double* force, double* free) {
    Plan& p = *plan_;
    int pushes = 0;
    for (std::size_t z = 0; z < p.weights.size(); ++z) {
        if (force[z] == 0) continue;
        const double* w = (p.pushed.empty() ? p.weights : p.pushed)[z].data();
        const int node = p.update.ports[z].node;
        const double push = p.update.gain * force[z];
        p.push[pushes++] = {w, node == 0 ? w + p.padded : w, push,
                            node != 0 && node % 2 == 0 ? -push : push};
    }
    const Pass pass{p.Ct.data(),
                    p.kappa.data(),
                    p.twocos.data(),
                    levels.displacement.data(),
                    levels.increment.data(),
                    p.padded,
                    p.push.data(),
                    pushes,
                    p.line.data(),
                    p.runs.data(),
                    static_cast<int>(p.runs.size()),
                    p.update.reads,
                    p.free.data()};
    HWY_DYNAMIC_DISPATCH(advance)(pass);
    for (int k = 0; k < p.update.reads; ++k) free[p.port[k]] = p.free[k];
}

void ThreePointPass::to_modal(const AlignedVector& level, double* modal) const {
    for (int j = 1; j < plan_->update.intervals; ++j) modal[j - 1] = level.data()[plan_->place(j)];
}

AlignedVector ThreePointPass::reading(const std::vector<double>& modal_weights) const {
    AlignedVector w(2 * plan_->padded);
    for (int j = 1; j < plan_->update.intervals; ++j)
        w.data()[plan_->place(j)] = modal_weights[j - 1];
    return w;
}

}  // namespace jvari
#endif
