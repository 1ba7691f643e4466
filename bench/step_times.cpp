// Time of a step, scheme by scene by modes: every scheme of the registry on every scene of the
// library that it represents, stepped as any caller does, with all taps at 44.1 kHz and the first 5
// ms again and again. At 705.6 kHz every scheme can take the most modes here; grids and waveguides
// follow the rate and not the modes. Beside the table three kernels stand by a plain form of each
// (tests/kernels): --benchmark_filter=pair/ picks them, modal_two_point/ a scheme. A Google
// Benchmark, run by hand: build/release/step_times.
#include <benchmark/benchmark.h>

#include <vector>

#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace {
using namespace jvari;
constexpr int steps_per_row = 16, rows = 220;

void step(benchmark::State& state, const Descriptor& d, const Scene& scene) try {
    const auto scheme =
        make_scheme(d, scene, {44100 * steps_per_row, 44100, static_cast<int>(state.range(0)), {}});
    const int taps = static_cast<int>(scene.taps.size());
    std::vector<double> tap(static_cast<std::size_t>(taps) * rows);
    const FlushDenormals flush;
    for (auto _ : state) {
        scheme->reset();
        benchmark::DoNotOptimize(scheme->advance({rows, taps, rows, tap.data(), nullptr}));
        benchmark::ClobberMemory();
    }
    state.counters["per_step"] =
        benchmark::Counter(rows * steps_per_row, benchmark::Counter::kIsIterationInvariantRate |
                                                     benchmark::Counter::kInvert);
} catch (const std::exception& refusal) { state.SkipWithError(refusal.what()); }
}  // namespace

int main(int argc, char** argv) {
    for (const Descriptor& d : schemes())
        for (const std::string& name : library_scenes()) {
            const Scene scene = read_scene(name);
            if (!(needed_by(scene) - d.represents).empty()) continue;
            benchmark::RegisterBenchmark(
                (std::string(d.name) + "/" + name).c_str(),
                [&d, scene](benchmark::State& state) { step(state, d, scene); })
                ->Arg(40)
                ->Arg(133)
                ->Arg(266);
        }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
