// exact_contact on the released C3 string, all four taps, and on scenes of other laws beside sundials. Counter `real_time`: simulated
// seconds per second.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace {
using namespace jvari;

void simulate(benchmark::State& state, Scheme& scheme, double duration, int taps) {
    const int rows = static_cast<int>(duration * 44100);
    std::vector<double> tap(static_cast<std::size_t>(taps) * rows);
    const FlushDenormals flush;
    for (auto _ : state) {
        scheme.reset();
        benchmark::DoNotOptimize(scheme.advance({rows, taps, rows, tap.data(), nullptr}));
        benchmark::ClobberMemory();
    }
    state.counters["real_time"] = benchmark::Counter(static_cast<double>(state.iterations()) * duration, benchmark::Counter::kIsRate);
}

void release(benchmark::State& state, int modes, double duration) {
    Scene scene = c3_release();
    scene.duration = duration;
    simulate(state, *make_scheme(exact_contact, scene, {0, 44100, modes, {}}), duration, 4);
}

// What the modes cut off leave out in series, and other laws of contact at a tolerance of their own.
void matched(benchmark::State& state) {
    const Scene scene = c3_release();
    simulate(state, *make_scheme(exact_contact, scene, {0, 44100, 133, {{"compliance", "matched"}}}), 1, 4);
}
void law(benchmark::State& state, double exponent, double loss) {
    Scene scene = c3_release();
    auto& bridge = std::get<LumpedBarrier>(scene.strings.front().barriers.front());
    bridge.exponent = exponent;
    bridge.contact_loss = loss;
    simulate(state, *make_scheme(exact_contact, scene, {0, 44100, 133, {{"tolerance", "1e-8"}}}), 0.1, 4);
}

// Scenes of other laws beside sundials. Counter `error`: of the first displacement, relative L2 against exact_contact at 1e-13.
void beside(benchmark::State& state, const Descriptor& descriptor, const char* option, const char* tolerance, const char* name,
            double duration) {
    Scene scene = read_scene(name);
    scene.duration = duration;
    const auto at = [&](const Descriptor& d, const char* o, const char* t) { return run(d, scene, {0, 44100, 0, {{o, t}}}); };
    const Run truth = at(exact_contact, "tolerance", "1e-13"), r = at(descriptor, option, tolerance);
    const auto tap = std::find_if(scene.taps.begin(), scene.taps.end(), [](const Tap& t) { return t.quantity == Quantity::displacement; });
    const int column = static_cast<int>(tap - scene.taps.begin());
    double difference = 0, size = 0;
    for (long n = 0; n < r.trace.rows; ++n) {
        difference += std::pow(r.trace.column(column)[n] - truth.trace.column(column)[n], 2);
        size += std::pow(truth.trace.column(column)[n], 2);
    }
    simulate(state, *make_scheme(descriptor, scene, {0, 44100, 0, {{option, tolerance}}}), duration, static_cast<int>(scene.taps.size()));
    state.counters["error"] = std::sqrt(difference / size);
}
BENCHMARK_CAPTURE(release, macro_133_first_20_ms, 133, 0.02)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(release, macro_133_second, 133, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(release, macro_600_tenth, 600, 0.1)->Unit(benchmark::kMillisecond);
BENCHMARK(matched)->Name("matched_133_second")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(law, exponent_1_3_lossy, 1.3, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(law, exponent_2_lossy, 2, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(beside, parabola_exact, exact_contact, "tolerance", "1e-8", "sitar_parabola", 2e-3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(beside, parabola_sundials, sundials, "rtol", "1e-12", "sitar_parabola", 2e-3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(beside, two_points_exact, exact_contact, "tolerance", "3e-9", "two_point_bridge", 1e-2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(beside, two_points_sundials, sundials, "rtol", "1e-12", "two_point_bridge", 1e-2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(release, macro_600_first_20_ms, 600, 0.02)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
