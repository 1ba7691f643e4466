// exact_contact beside the other algorithm for the same numbers, stepwise_contact, in one run: the released C3 string, all four taps.
// Counter `real_time`: simulated seconds per second. Counter `difference`: of the bridge force over the first 20 ms, relative L2.
#include <benchmark/benchmark.h>

#include <cmath>

#include "reference/references.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"
#include "tests/stepwise_contact.hpp"

namespace {
using namespace jvari;

void release(benchmark::State& state, const Descriptor& descriptor, int modes, double duration) {
    Scene scene = c3_release();
    scene.duration = 0.02;
    const Settings settings{0, 44100, modes, {}};
    const Run truth = run(stepwise_contact, scene, settings), r = run(descriptor, scene, settings);
    double difference = 0, size = 0;
    for (long n = 0; n < r.trace.rows; ++n) {
        difference += std::pow(r.trace.column(2)[n] - truth.trace.column(2)[n], 2);
        size += std::pow(truth.trace.column(2)[n], 2);
    }
    scene.duration = duration;
    const auto scheme = make_scheme(descriptor, scene, settings);
    const int rows = static_cast<int>(duration * 44100);
    std::vector<double> tap(4 * rows);
    const FlushDenormals flush;
    for (auto _ : state) {
        scheme->reset();
        benchmark::DoNotOptimize(scheme->advance({rows, 4, rows, tap.data(), nullptr}));
        benchmark::ClobberMemory();
    }
    state.counters["real_time"] = benchmark::Counter(static_cast<double>(state.iterations()) * duration, benchmark::Counter::kIsRate);
    state.counters["difference"] = std::sqrt(difference / size);
}
BENCHMARK_CAPTURE(release, macro_133_first_20_ms, exact_contact, 133, 0.02)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(release, stepwise_133_first_20_ms, stepwise_contact, 133, 0.02)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(release, macro_133_second, exact_contact, 133, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(release, stepwise_133_second, stepwise_contact, 133, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(release, macro_600_first_20_ms, exact_contact, 600, 0.02)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(release, stepwise_600_first_20_ms, stepwise_contact, 600, 0.02)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
