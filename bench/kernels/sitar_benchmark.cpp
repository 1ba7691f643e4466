// One step of the sitar schemes on strings as long in samples as f0 = 50 Hz ... 1 kHz are at 44.1 kHz, with a curved bridge of four nodes
// or none, in one plane or two. 16 steps a row, at 16 times f0 and rate, so that writing rows does not count; back to t = 0 after 20
// periods, while the string still meets the bridge. The waveguide should not see the string's length; the finite difference is as long as
// the string. The waveguide's rails alone, at 256 steps a row: one plane takes half the time of two.
#include <benchmark/benchmark.h>

#include <cmath>

#include "tests/sitar_scenes.hpp"

namespace {
using namespace jvari;

void step(benchmark::State& state, const char* name, int bridge_nodes, bool two_planes, int steps_per_row = 16) {
    constexpr int rows = 16;
    const int steps = rows * steps_per_row;
    const int cells = static_cast<int>(std::lround(22050.0 / static_cast<double>(state.range(0))));
    Scene scene = sitar_scene(44100.0 * steps_per_row / (2 * cells));
    String& string = scene.strings[0];
    string.damping = PerPeriodDamping{0.991};
    if (bridge_nodes > 0) string.barriers = {bridge(LineCurve{-0.008}, (bridge_nodes + 0.5) * string.length / cells)};
    if (two_planes) string.polarisation = Polarisation{0.05, 0};
    scene.taps = {tap(Quantity::nut_force)};
    const auto scheme = make_scheme(scheme_named(name), scene, {44100.0 * steps_per_row, 44100, 0, {}});
    double taps[rows];
    const FlushDenormals flush;
    const int blocks = 20 * 2 * cells / steps + 1;
    int block = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scheme->advance({rows, 1, rows, taps, nullptr}));
        benchmark::ClobberMemory();
        if (++block == blocks) {
            state.PauseTiming();
            scheme->reset();
            block = 0;
            state.ResumeTiming();
        }
    }
    state.counters["dofs"] = scheme->dofs();
    state.counters["ns/step"] = benchmark::Counter(1e-9 * steps * static_cast<double>(state.iterations()),
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
#define OVER_F0 ->Arg(50)->Arg(100)->Arg(200)->Arg(523)->Arg(1000)
BENCHMARK_CAPTURE(step, waveguide, "sitar_waveguide", 0, false) OVER_F0;
BENCHMARK_CAPTURE(step, waveguide_bridge, "sitar_waveguide", 4, false) OVER_F0;
BENCHMARK_CAPTURE(step, waveguide_two_planes, "sitar_waveguide", 0, true) OVER_F0;
BENCHMARK_CAPTURE(step, waveguide_two_planes_bridge, "sitar_waveguide", 4, true) OVER_F0;
BENCHMARK_CAPTURE(step, rails, "sitar_waveguide", 0, false, 256) OVER_F0;
BENCHMARK_CAPTURE(step, rails_two_planes, "sitar_waveguide", 0, true, 256) OVER_F0;
BENCHMARK_CAPTURE(step, fdm, "sitar_fdm", 0, false) OVER_F0;
BENCHMARK_CAPTURE(step, fdm_bridge, "sitar_fdm", 4, false) OVER_F0;
}  // namespace

BENCHMARK_MAIN();
