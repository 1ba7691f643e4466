// A drone of four strings of 133 modes at 44.1 kHz, heard through its body at bridge and nut: without the body, by convolution with 2048
// rows a side in blocks of 512, and by 16, 32 and 64 second-order sections a side fitted to them. Counters: `real_time`, seconds of sound
// in a second of one core, and `misfit_db`, the worse of the two fits. The responses are synthetic (tests/synthetic_body.hpp).
#include <benchmark/benchmark.h>

#include <algorithm>

#include "analysis/convolution.hpp"
#include "analysis/resonators.hpp"
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

enum class Body { none, convolved, sections };

void drone(benchmark::State& state, Body body, int sections) {
    const Scene scene = read_scene("tanpura_drone");  // its taps: driving force at the bridge, force at the nut
    const auto scheme = make_scheme(schemes()[0], scene, settings());
    std::vector<Convolution> convolutions;
    std::vector<Resonators> fits;
    double misfit = -300;
    for (const BodyEnd end : {BodyEnd::bridge, BodyEnd::nut}) {
        const std::vector<double> response = synthetic::synthetic_response(end);
        convolutions.emplace_back(response, block);
        if (body != Body::sections) continue;
        fits.push_back(resonators_for(response, settings().tap_rate, sections));
        misfit = std::max(misfit, misfit_db(fits.back(), response));
    }
    std::vector<double> tap(2 * rows), heard(rows);
    const FlushDenormals flush;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scheme->advance({rows, 2, rows, tap.data(), nullptr}));
        for (int side = 0; side < 2; ++side) {
            const std::span<const double> force(tap.data() + side * rows, rows);
            for (int row = 0; body == Body::convolved && row < rows; row += block)
                convolutions[side].advance(force.subspan(row, block), std::span(heard).subspan(row, block));
            benchmark::DoNotOptimize(heard.data());
            if (body == Body::sections) benchmark::DoNotOptimize(filtered(fits[side], force));
        }
        if (state.iterations() % 51 == 50) scheme->reset();  // all of its 4.8 s
    }
    state.counters["real_time"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * rows / settings().tap_rate, benchmark::Counter::kIsRate);
    if (body == Body::sections) state.counters["misfit_db"] = misfit;
}
BENCHMARK_CAPTURE(drone, no_body, Body::none, 0);
BENCHMARK_CAPTURE(drone, convolved_2048, Body::convolved, 0);
BENCHMARK_CAPTURE(drone, sections_16, Body::sections, 16);
BENCHMARK_CAPTURE(drone, sections_32, Body::sections, 32);
BENCHMARK_CAPTURE(drone, sections_64, Body::sections, 64);

}  // namespace

BENCHMARK_MAIN();
