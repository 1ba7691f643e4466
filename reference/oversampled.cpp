#include "reference/oversampled.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/registry.hpp"

namespace jvari {

Oversampled oversampled(const Descriptor& scheme, const Scene& scene, const Settings& settings, int multiple, const RunOptions& options) {
    if (multiple < 4 || multiple % 4 != 0)
        throw Refusal("oversampling by " + std::to_string(multiple) +
                      ": expected a multiple of 4, so that three rates stand below each other");
    Oversampled result;
    Run coarser[2];
    for (int level = 0; level < 3; ++level) {
        Settings s = settings;
        result.rate = s.sample_rate = settings.sample_rate * (multiple >> (2 - level));
        Run r = run(scheme, scene, s, options);
        result.wall_seconds += r.wall_seconds;
        const bool failed = r.status.outcome != Outcome::ok;
        if (level == 2 || failed) result.run = std::move(r);
        else coarser[level] = std::move(r);
        if (failed) return result;
    }
    const Trace &a = coarser[0].trace, &b = coarser[1].trace, &c = result.run.trace;
    for (int k = 0; k < c.taps(); ++k) {
        auto& tap = result.estimates.emplace_back();
        for (std::size_t w = 0; w < agreement_windows.size(); ++w) {
            const double first = relative_difference(a.column(k), b.column(k), c.tap_rate, agreement_windows[w]);
            const double last = relative_difference(b.column(k), c.column(k), c.tap_rate, agreement_windows[w]);
            const bool rounding = !(last > 1e-13);
            const double order = rounding ? std::numeric_limits<double>::quiet_NaN() : std::log2(first / last);
            const double p = rounding ? trusted_order : std::clamp(order, 0.25, trusted_order);
            tap[w] = {last, order, caution * last / (std::exp2(p) - 1)};
        }
    }
    return result;
}

const Descriptor* stand_in(const Scene& scene) {
    const Descriptor* chosen = nullptr;
    int best = 0;
    for (const Descriptor& d : schemes()) {
        if (!(needed_by(scene) - d.represents).empty()) continue;
        if (d.stand_in_rank > best) best = d.stand_in_rank, chosen = &d;
    }
    return chosen;
}

}  // namespace jvari
