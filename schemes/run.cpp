#include "schemes/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace jvari {

#if defined(__SSE2__)
FlushDenormals::FlushDenormals() noexcept : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | 0x8040u);
}  // FTZ | DAZ
FlushDenormals::~FlushDenormals() {
    _mm_setcsr(saved_);
}
#else
FlushDenormals::FlushDenormals() noexcept : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;
#endif

namespace {
// The first row in [from, to) that no sound run can have: a value that is not finite, or more energy stored than `energy_budget` times what
// was there at the start and has been supplied since. `to` where all are sound. `given` sums the supply.
long first_unsound_row(const Trace& t, long from, long to, double& given) {
    for (long n = from; n < to; ++n) {
        for (int k = 0; k < t.taps(); ++k)
            if (!std::isfinite(t.tap[k * t.stride + n])) return n;
        if (t.energy.empty()) continue;
        const double stored = t.energy[n];
        given += std::abs(n == 0 ? stored : t.energy[t.stride + n]);
        if (!std::isfinite(stored) || stored > energy_budget * given) return n;
    }
    return to;
}
}  // namespace

Run run(Scheme& scheme, const Scene& scene, const Settings& settings, const RunOptions& options) {
    Run result;
    Trace& trace = result.trace;
    trace.tap_rate = settings.tap_rate;
    trace.stride = std::lround(scene.duration * settings.tap_rate) + 1;
    for (const Tap& tap : scene.taps) trace.names.push_back(tap.name);
    trace.tap.assign(trace.stride * trace.names.size(), 0.0);
    if (options.energy) trace.energy.assign(trace.stride * 3, 0.0);
    result.dofs = scheme.dofs();
    const double steps_per_row = settings.sample_rate / settings.tap_rate;

    scheme.reset();
    const FlushDenormals flush;
    std::chrono::steady_clock::duration stepping{};
    double given = 0;
    while (trace.rows < trace.stride && result.status.outcome == Outcome::ok) {
        Block block;
        block.rows = static_cast<int>(std::min<long>(options.block_rows, trace.stride - trace.rows));
        block.taps = trace.taps();
        block.stride = trace.stride;
        block.tap = trace.tap.data() + trace.rows;
        block.energy = options.energy ? trace.energy.data() + trace.rows : nullptr;
        const auto start = std::chrono::steady_clock::now();
        result.status = scheme.advance(block);
        const auto took = std::chrono::steady_clock::now() - start;
        stepping += took;
        if (trace.rows > 0 && block.rows == options.block_rows)
            result.worst_block = std::max(result.worst_block, std::chrono::duration<double>(took).count());

        long end = trace.rows + block.rows;
        if (result.status.outcome != Outcome::ok) end = std::min(end, static_cast<long>(result.status.step / steps_per_row) + 1);
        const long sound = first_unsound_row(trace, trace.rows, end, given);
        if (sound < end) result.status = {Outcome::diverged, std::lround(sound * steps_per_row)};
        trace.rows = sound;
        if (options.progress) options.progress(trace.rows, trace.stride);
    }
    result.steps = std::lround(steps_per_row * static_cast<double>(trace.rows));
    result.wall_seconds = std::chrono::duration<double>(stepping).count();
    result.facts = scheme.facts();
    return result;
}

Run run(const Descriptor& descriptor, const Scene& scene, const Settings& settings, const RunOptions& options) {
    const auto scheme = make_scheme(descriptor, scene, settings);
    Run result = run(*scheme, scene, settings, options);
    if (descriptor.clock == Clock::continuous) result.steps = 0;
    return result;
}

}  // namespace jvari
