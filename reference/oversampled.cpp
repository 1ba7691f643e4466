#include "reference/oversampled.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/excitation.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"

namespace jvari {

Oversampled oversampled(const Descriptor& scheme, const Scene& scene, const Settings& settings,
                        int multiple, const RunOptions& options) {
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
    const double from = free_from(scene) < scene.duration ? free_from(scene) : 0;
    const Trace &a = coarser[0].trace, &b = coarser[1].trace, &c = result.run.trace;
    for (int k = 0; k < c.taps(); ++k) {
        auto& tap = result.estimates.emplace_back();
        for (std::size_t w = 0; w < agreement_windows.size(); ++w) {
            const auto free = [&](const Trace& t) {
                return rows_from(t.column(k), from, t.tap_rate);
            };
            const double first =
                relative_difference(free(a), free(b), c.tap_rate, agreement_windows[w]);
            const double last =
                relative_difference(free(b), free(c), c.tap_rate, agreement_windows[w]);
            const bool rounding = !(last > 1e-13);
            const double p =
                rounding ? trusted_order : std::clamp(std::log2(first / last), 0.25, trusted_order);
            tap[w] = caution * last / (std::exp2(p) - 1);
        }
    }
    return result;
}

std::vector<const Descriptor*> stand_ins(const Scene& scene) {
    std::vector<const Descriptor*> able;
    for (const Descriptor& d : schemes()) {
        if (!represents(d, scene) || d.stand_in_rank < 1) continue;
        if (!able.empty() && d.stand_in_rank > able.front()->stand_in_rank) able.clear();
        if (able.empty() || d.stand_in_rank == able.front()->stand_in_rank) able.push_back(&d);
    }
    return able;
}

double estimate_of(const Descriptor& scheme, const Scene& scene, const Settings& settings,
                   int multiple, const RunOptions& options) {
    Scene start = scene;
    start.duration = std::min(scene.duration, trial);
    double worst = 0;
    try {
        const Oversampled o = oversampled(scheme, start, settings, multiple, options);
        if (o.estimates.empty()) return HUGE_VAL;
        for (const auto& tap : o.estimates) worst = std::max(worst, tap.back());
    } catch (const Refusal&) { return HUGE_VAL; }
    return worst;
}

const Descriptor* best_by_estimate(const std::vector<const Descriptor*>& candidates,
                                   const Scene& scene, const Settings& settings, int multiple,
                                   const RunOptions& options) {
    if (candidates.size() < 2) return candidates.empty() ? nullptr : candidates.front();
    const Descriptor* best = candidates.front();
    double least = HUGE_VAL;
    for (const Descriptor* d : candidates)
        if (const double error = estimate_of(*d, scene, settings, multiple, options); error < least)
            least = error, best = d;
    return best;
}

}  // namespace jvari
