// The fused kernel of modal_two_point beside a plain Eigen form of the same scheme, in one run: the
// plucked C3 string, 133 modes, with nut, bridge and thread taps at every step of 44.1 kHz. Counter
// `error`: bridge force over 1 s against the same scheme in long double, relative to the largest.
// (Released from the first mode instead, the same string amplifies a rounding by 1e8 in 1 s, and
// both forms end near 1e-8.)
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"
#include "tests/plugin/plain_two_point.hpp"

namespace {
using namespace jvari;

constexpr Settings settings() { return {44100, 44100, 133, {}}; }

Scene three_taps() {
    Scene scene = c3_pluck();
    std::erase_if(scene.taps, [](const Tap& tap) { return tap.name == "y03"; });
    return scene;
}

std::unique_ptr<Scheme> fused(const Scene& scene, const Settings& s) {
    return make_scheme(schemes()[0], scene, s);
}
template <class Real>
std::unique_ptr<Scheme> plain(const Scene& scene, const Settings& s) {
    return std::make_unique<PlainTwoPoint<Real>>(scene, s);
}

double bridge_error(Scheme& scheme, const Scene& scene) {
    static const Run truth =
        run(*plain<long double>(three_taps(), settings()), three_taps(), settings());
    const Run r = run(scheme, scene, settings());
    const auto want = truth.trace.column(1), got = r.trace.column(1);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < want.size(); ++n) {
        largest = std::max(largest, std::abs(want[n]));
        difference = std::max(difference, std::abs(want[n] - got[n]));
    }
    return difference / largest;
}

template <std::unique_ptr<Scheme> (*make)(const Scene&, const Settings&)>
void step(benchmark::State& state) {
    const Scene scene = three_taps();
    const auto scheme = make(scene, settings());
    const double error = bridge_error(*scheme, scene);
    scheme->reset();
    constexpr int rows = 64;
    double tap[rows * 3];
    const FlushDenormals flush;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scheme->advance({rows, 3, rows, tap, nullptr}));
        benchmark::ClobberMemory();
        if (state.iterations() % 690 == 689) scheme->reset();  // stay within the first second
    }
    state.counters["per_step"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * rows,
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["error"] = error;
}
BENCHMARK(step<fused>)->Name("pair/two_point/kernel");
BENCHMARK(step<plain<double>>)->Name("pair/two_point/plain");
}  // namespace
