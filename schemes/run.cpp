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

Run run(Scheme& scheme, const Scene& scene, const Settings& settings, const RunOptions& options) {
    Run result;
    Trace& trace = result.trace;
    trace.tap_rate = settings.tap_rate;
    trace.stride = std::lround(scene.duration * settings.tap_rate) + 1;
    for (const Tap& tap : scene.taps) trace.names.push_back(tap.name);
    trace.tap.assign(trace.stride * trace.names.size(), 0.0);
    if (options.energy) trace.energy.assign(trace.stride * 3, 0.0);
    result.dofs = scheme.dofs();

    scheme.reset();
    const FlushDenormals flush;
    std::chrono::steady_clock::duration stepping{};
    while (trace.rows < trace.stride && result.status.outcome == Outcome::ok) {
        Block block;
        block.rows = static_cast<int>(std::min<long>(options.block_rows, trace.stride - trace.rows));
        block.taps = trace.taps();
        block.stride = trace.stride;
        block.tap = trace.tap.data() + trace.rows;
        block.energy = options.energy ? trace.energy.data() + trace.rows : nullptr;
        const auto start = std::chrono::steady_clock::now();
        result.status = scheme.advance(block);
        stepping += std::chrono::steady_clock::now() - start;
        trace.rows += block.rows;
        if (options.progress) options.progress(trace.rows, trace.stride);
    }
    const double per_row = settings.sample_rate / settings.tap_rate;
    if (result.status.outcome != Outcome::ok)  // the row that follows the failing step is not valid
        trace.rows = std::min(trace.rows, static_cast<long>(std::floor(result.status.step / std::max(per_row, 1.0))) + 1);
    result.steps = std::lround(per_row * trace.rows);
    result.wall_seconds = std::chrono::duration<double>(stepping).count();
    result.facts = scheme.facts();
    return result;
}

Run run(const Descriptor& descriptor, const Scene& scene, const Settings& settings, const RunOptions& options) {
    const auto scheme = descriptor.make(scene, settings);
    Run result = run(*scheme, scene, settings, options);
    if (descriptor.clock == Clock::continuous) result.steps = 0;
    return result;
}

}  // namespace jvari
