// The fused kernel of modal_two_point beside a plain Eigen form of the same scheme, in one run: the plucked C3 string, 133 modes, with nut,
// bridge and thread taps at every step of 44.1 kHz. Counter `error`: bridge force over 1 s against the same scheme in long double, relative
// to the largest. (Released from the first mode instead, the same string amplifies a rounding by 1e8 in 1 s, and both forms end near 1e-8.)
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"
#include "tests/plugin/plain_two_point.hpp"

namespace {
using namespace jvari;

constexpr Settings settings() {
    return {44100, 44100, 133, {}};
}

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
    static const Run truth = run(*plain<long double>(three_taps(), settings()), three_taps(), settings());
    const Run r = run(scheme, scene, settings());
    const auto want = truth.trace.column(1), got = r.trace.column(1);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < want.size(); ++n) {
        largest = std::max(largest, std::abs(want[n]));
        difference = std::max(difference, std::abs(want[n] - got[n]));
    }
    return difference / largest;
}

void time_rows(benchmark::State& state, Scheme& scheme) {
    constexpr int rows = 64;
    double tap[rows * 3];
    const FlushDenormals flush;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scheme.advance({rows, 3, rows, tap, nullptr}));
        benchmark::ClobberMemory();
        if (state.iterations() % 690 == 689) scheme.reset();  // stay within the first second
    }
    state.SetItemsProcessed(state.iterations() * rows);
    state.counters["ns_per_step"] = benchmark::Counter(static_cast<double>(state.iterations()) * rows * 1e-9,
                                                       benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <std::unique_ptr<Scheme> (*make)(const Scene&, const Settings&)>
void step(benchmark::State& state) {
    const Scene scene = three_taps();
    const auto scheme = make(scene, settings());
    const double error = bridge_error(*scheme, scene);
    scheme->reset();
    time_rows(state, *scheme);
    state.counters["error"] = error;
}
// The same with what is missing of the string's compliance in series. Its errors are in docs/compliance-matching.md: there is no plain form
// to take them against.
void matched(benchmark::State& state) {
    Settings s = settings();
    s.options = {{"compliance", "matched"}};
    time_rows(state, *fused(three_taps(), s));
}
BENCHMARK(step<fused>)->Name("two_point/fused");
BENCHMARK(matched)->Name("matched/two_point");
BENCHMARK(step<plain<double>>)->Name("two_point/plain_eigen");

// Strings as runs of one and as one scene: four of different pitch, four times those, and an ensemble of sixteen that differ in how they
// are plucked alone. Counter `error`: the bridge force of all over 0.2 s against long double, relative to the largest.
enum class Strings { four_pitches, ensemble };
Scene strings(Strings kind, int count) {
    Scene scene = three_taps();
    const String c3 = scene.strings.front();
    scene.strings.clear();
    for (int k = 0; k < count; ++k) {
        String& s = scene.strings.emplace_back(c3);
        if (kind == Strings::ensemble) s.pluck->amplitude *= 1 - 0.06 * (k % 4);
        else s.tension *= 1 - 0.06 * (k % 4);
    }
    for (Tap& tap : scene.taps) tap.string.reset();  // of all strings
    scene.duration = 0.2;
    return scene;
}

void several(benchmark::State& state, Strings kind, bool together) {
    const int count = static_cast<int>(state.range(0));
    const Scene scene = strings(kind, count);
    std::vector<Scene> parts = together ? std::vector<Scene>{scene} : std::vector<Scene>{};
    for (int k = 0; !together && k < count; ++k) parts.push_back(alone(scene, k));
    std::vector<std::unique_ptr<Scheme>> schemes;
    std::vector<double> want, got;
    const auto add = [](std::vector<double>& sum, std::span<const double> part) {
        sum.resize(part.size());
        for (std::size_t n = 0; n < part.size(); ++n) sum[n] += part[n];
    };
    for (const Scene& part : parts) {
        schemes.push_back(fused(part, settings()));
        add(got, run(*schemes.back(), part, settings()).trace.column(1));
        schemes.back()->reset();
    }
    static std::map<Strings, std::vector<double>> truths;
    if (!truths.contains(kind)) {
        std::vector<double>& sum = truths[kind];
        for (int k = 0; k < 4; ++k)
            add(sum, run(*plain<long double>(alone(scene, k), settings()), alone(scene, k), settings()).trace.column(1));
    }
    for (int k = 0; k < count; k += 4) add(want, truths[kind]);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < want.size(); ++n) {
        largest = std::max(largest, std::abs(want[n]));
        difference = std::max(difference, std::abs(want[n] - got[n]));
    }
    constexpr int rows = 64;
    double tap[rows * 3];
    const FlushDenormals flush;
    for (auto _ : state) {
        for (const auto& scheme : schemes) benchmark::DoNotOptimize(scheme->advance({rows, 3, rows, tap, nullptr}));
        benchmark::ClobberMemory();
        if (state.iterations() % 690 == 689)
            for (const auto& scheme : schemes) scheme->reset();
    }
    state.counters["ns_per_string_step"] = benchmark::Counter(static_cast<double>(state.iterations()) * rows * count * 1e-9,
                                                              benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["error"] = difference / largest;
}
BENCHMARK_CAPTURE(several, one_by_one, Strings::four_pitches, false)->Arg(4)->Arg(16);
BENCHMARK_CAPTURE(several, together, Strings::four_pitches, true)->Arg(4)->Arg(16);
BENCHMARK_CAPTURE(several, ensemble_one_by_one, Strings::ensemble, false)->Arg(16);
BENCHMARK_CAPTURE(several, ensemble_together, Strings::ensemble, true)->Arg(16);

// What a scene listens to is what it pays for: all four taps at every step, against one displacement at 1/64 of them.
void taps(benchmark::State& state, bool all) {
    Scene scene = c3_release();
    if (!all) scene.taps = {scene.taps[1]};
    const auto scheme = fused(scene, {44100 * 64, all ? 44100.0 * 64 : 44100, 133, {}});
    const int rows = all ? 640 : 10;
    std::vector<double> tap(rows * scene.taps.size());
    const FlushDenormals flush;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scheme->advance({rows, static_cast<int>(scene.taps.size()), rows, tap.data(), nullptr}));
        if (state.iterations() % 4000 == 3999) scheme->reset();
    }
    state.counters["ns_per_step"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * 640e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(taps, four_each_step, true);
BENCHMARK_CAPTURE(taps, one_displacement_each_64, false);

}  // namespace

BENCHMARK_MAIN();
