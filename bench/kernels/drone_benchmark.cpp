// A drone of four strings of 133 modes at 44.1 kHz, heard through its body at bridge and nut: without the body, and by convolution with
// 2048 rows a side in blocks of 512. The counter `real_time`: seconds of sound in a second of one core. The responses are synthetic
// (tests/synthetic_body.hpp).
#include <benchmark/benchmark.h>

#include "analysis/convolution.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/synthetic_body.hpp"

namespace {
using namespace jvari;
using synthetic::BodyEnd;

constexpr Settings settings() {
    return {44100, 44100, 133, {}};
}
constexpr int rows = 4096, block = 512;  // of an iteration, of the convolution

void drone(benchmark::State& state, bool convolved) {
    const Scene scene = read_scene("tanpura_drone");  // its taps: driving force at the bridge, force at the nut
    const auto scheme = make_scheme(schemes()[0], scene, settings());
    std::vector<Convolution> convolutions;
    for (const BodyEnd end : {BodyEnd::bridge, BodyEnd::nut}) convolutions.emplace_back(synthetic::synthetic_response(end), block);
    std::vector<double> tap(2 * rows), heard(rows);
    const FlushDenormals flush;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scheme->advance({rows, 2, rows, tap.data(), nullptr}));
        for (int side = 0; side < 2; ++side) {
            const std::span<const double> force(tap.data() + side * rows, rows);
            for (int row = 0; convolved && row < rows; row += block)
                convolutions[side].advance(force.subspan(row, block), std::span(heard).subspan(row, block));
            benchmark::DoNotOptimize(heard.data());
        }
        if (state.iterations() % 51 == 50) scheme->reset();  // all of its 4.8 s
    }
    state.counters["real_time"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * rows / settings().tap_rate, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(drone, no_body, false);
BENCHMARK_CAPTURE(drone, convolved_2048, true);

}  // namespace

BENCHMARK_MAIN();
