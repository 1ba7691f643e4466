// The quadratised schemes and the energy columns, in one run: whole schemes on the C3 string with four taps at every step, without and with
// energies, beside modal_two_point; 512 modes at 705.6 kHz.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace {
using namespace jvari;

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
