// One step of the sitar schemes over f0 from 50 Hz to 1 kHz at 44.1 kHz: the nut force at every row, a curved bridge of four nodes
// whatever f0 or none, one plane or two. The waveguide should not see the string's length; the finite difference is as long as the string.
#include <benchmark/benchmark.h>

#include <cmath>

#include "tests/sitar_scenes.hpp"

namespace {
using namespace jvari;

void step(benchmark::State& state, const char* name, int bridge_nodes, bool two_planes) {
    Scene scene = sitar_scene(static_cast<double>(state.range(0)));
    String& string = scene.strings[0];
    const double dx = string.length / std::round(22050.0 / static_cast<double>(state.range(0)));
    string.damping = PerPeriodDamping{0.991};
    if (bridge_nodes > 0) string.barriers = {bridge(LineCurve{-0.008}, (bridge_nodes + 0.5) * dx)};
    if (two_planes) string.polarisation = Polarisation{0.05, 0};
    scene.taps = {tap(Quantity::nut_force)};
    const auto scheme = scheme_named(name).make(scene, {44100, 44100, 0, {}});
    constexpr int rows = 64;
    double taps[rows];
    const FlushDenormals flush;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scheme->advance({rows, 1, rows, taps, nullptr}));
        benchmark::ClobberMemory();
        if (state.iterations() % 690 == 689) scheme->reset();  // stay within the first second
    }
    state.counters["dofs"] = scheme->dofs();
    state.counters["ns/step"] = benchmark::Counter(1e-9 * rows * static_cast<double>(state.iterations()),
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
#define OVER_F0 ->Arg(50)->Arg(100)->Arg(200)->Arg(523)->Arg(1000)
BENCHMARK_CAPTURE(step, waveguide, "sitar_waveguide", 0, false) OVER_F0;
BENCHMARK_CAPTURE(step, waveguide_bridge, "sitar_waveguide", 4, false) OVER_F0;
BENCHMARK_CAPTURE(step, waveguide_two_planes, "sitar_waveguide", 0, true) OVER_F0;
BENCHMARK_CAPTURE(step, waveguide_two_planes_bridge, "sitar_waveguide", 4, true) OVER_F0;
BENCHMARK_CAPTURE(step, fdm, "sitar_fdm", 0, false) OVER_F0;
BENCHMARK_CAPTURE(step, fdm_bridge, "sitar_fdm", 4, false) OVER_F0;
}  // namespace

BENCHMARK_MAIN();
