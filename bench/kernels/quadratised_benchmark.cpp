// The quadratised schemes and the energy columns, in one run. `pass` and `energies`: what a step of the three-point form asks of the modes,
// fused, beside the plain loops that it replaces; counter `error`: against the same loops in long double, relative. `step`: whole schemes
// on the C3 string with four taps at every step, without and with energies, beside modal_two_point; 512 modes at 705.6 kHz.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "schemes/modal/kernels/modal_energies.hpp"
#include "schemes/modal/modal_string.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace {
using namespace jvari;

struct Arrays {  // of a string with barrier and thread
    ModalArray x, v, p, r, g_b, g_c, e_b, e_c, W, den;
    ModalPass pass;
    explicit Arrays(int size) {
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> any(0, 1);
        for (ModalArray* a : {&x, &v, &p, &r, &g_b, &g_c, &e_b, &e_c, &W, &den}) {
            a->resize((size + 7) / 8 * 8);
            for (int i = 0; i < size; ++i) (*a)[i] = any(random);
        }
        pass = {static_cast<int>(x.size()), x.data(), v.data(), p.data(), r.data(), g_b.data(), g_c.data(), e_b.data(), e_c.data()};
        pass.F_b = 0.3, pass.F_c = -0.2;
    }
};

struct Sums {
    long double y_b, r_b, lost, after, before;
};
template <class Real>
Sums plain(const ModalPass& m, const Arrays& a, bool move) {
    Real y_b = 0, r_b = 0, y_c = 0, r_c = 0, lost = 0, after = 0, before = 0;
    for (int i = 0; i < m.size; ++i) {
        const Real x = m.x[i], v = m.v[i], p = m.p[i], r = m.r[i];
        const Real next = v - p * v - r * x + m.e_b[i] * Real(m.F_b) + m.e_c[i] * Real(m.F_c);
        if (move) {
            const Real to = x + next, then = 2 * next - p * next - r * to;
            y_b += m.g_b[i] * to, r_b += m.g_b[i] * then, y_c += m.g_c[i] * to, r_c += m.g_c[i] * then;
        } else {
            const Real s = next + v, high = 2 * x + next, low = 2 * x - v;
            lost += a.W[i] * p * s * s;
            after += a.W[i] * (a.den[i] * next * next + r * high * high);
            before += a.W[i] * (a.den[i] * v * v + r * low * low);
        }
    }
    benchmark::DoNotOptimize(y_c + r_c);
    return {y_b, r_b, lost, after, before};
}
double off(double got, long double want) {
    return static_cast<double>(std::abs((got - want) / want));
}

void pass(benchmark::State& state, bool fused) {
    Arrays a(static_cast<int>(state.range(0)));
    const auto step = three_point_pass(true, true, false);
    const Sums want = plain<long double>(a.pass, a, true), rounded = plain<double>(a.pass, a, true);
    step(a.pass);
    state.counters["error"] =
        fused ? std::max(off(a.pass.x_b, want.y_b), off(a.pass.v_b, want.r_b))
              : std::max(off(static_cast<double>(rounded.y_b), want.y_b), off(static_cast<double>(rounded.r_b), want.r_b));
    std::fill(a.x.begin(), a.x.end(), 0.0);  // the motion stays bounded
    std::fill(a.v.begin(), a.v.end(), 0.0);
    for (auto _ : state) {
        if (fused) step(a.pass);
        else benchmark::DoNotOptimize(plain<double>(a.pass, a, true));
        benchmark::ClobberMemory();
    }
}
void energies(benchmark::State& state, bool fused) {
    const Arrays a(static_cast<int>(state.range(0)));
    const auto got = three_point_energies(a.pass, a.W.data(), a.den.data(), nullptr);
    const Sums want = plain<long double>(a.pass, a, false), rounded = plain<double>(a.pass, a, false);
    state.counters["error"] =
        fused ? std::max({off(got.spending.lost, want.lost), off(got.after, want.after), off(got.before, want.before)})
              : std::max({off(static_cast<double>(rounded.lost), want.lost), off(static_cast<double>(rounded.after), want.after),
                          off(static_cast<double>(rounded.before), want.before)});
    for (auto _ : state) {
        if (fused) benchmark::DoNotOptimize(three_point_energies(a.pass, a.W.data(), a.den.data(), nullptr));
        else benchmark::DoNotOptimize(plain<double>(a.pass, a, false));
        benchmark::ClobberMemory();
    }
}
BENCHMARK_CAPTURE(pass, fused, true)->Arg(133)->Arg(512);
BENCHMARK_CAPTURE(pass, plain, false)->Arg(133)->Arg(512);
BENCHMARK_CAPTURE(energies, fused, true)->Arg(133)->Arg(512);
BENCHMARK_CAPTURE(energies, plain, false)->Arg(133)->Arg(512);

void step(benchmark::State& state, const std::string& name, bool energy) {
    const int modes = static_cast<int>(state.range(0));
    const double rate = modes > 133 ? 705600 : 44100;
    const auto& all = schemes();
    const auto scheme = make_scheme(*std::find_if(all.begin(), all.end(), [&](const Descriptor& d) { return d.name == name; }),
                                    c3_release(), {rate, rate, modes, {}});
    constexpr int rows = 64;
    double tap[rows * 4], column[rows * 3];
    const FlushDenormals flush;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scheme->advance({rows, 4, rows, tap, energy ? column : nullptr}));
        benchmark::ClobberMemory();
        if (state.iterations() % 690 == 689) scheme->reset();
    }
    state.counters["ns_per_step"] = benchmark::Counter(static_cast<double>(state.iterations()) * rows * 1e-9,
                                                       benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(step, two_point, "modal_two_point", false)->Arg(133)->Arg(512);
BENCHMARK_CAPTURE(step, two_point_energies, "modal_two_point", true)->Arg(133)->Arg(512);
BENCHMARK_CAPTURE(step, quadratised, "modal_quadratised", false)->Arg(133)->Arg(512);
BENCHMARK_CAPTURE(step, quadratised_energies, "modal_quadratised", true)->Arg(133)->Arg(512);
BENCHMARK_CAPTURE(step, three_point, "modal_quadratised_three_point", false)->Arg(133)->Arg(512);
BENCHMARK_CAPTURE(step, three_point_energies, "modal_quadratised_three_point", true)->Arg(133)->Arg(512);

}  // namespace

BENCHMARK_MAIN();
