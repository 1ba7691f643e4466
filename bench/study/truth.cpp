#include "bench/study/truth.hpp"

#include <algorithm>

#include "bench/study/errors.hpp"
#include "reference/agreement.hpp"
#include "reference/references.hpp"
#include "schemes/contact/compliance.hpp"

namespace jvari::bench::study {

double change(const Trace& more, const Trace& fewer, int tap, double from, std::size_t waveform) {
    const double rate = more.tap_rate;
    const auto a = rows_for(waveform, fewer, tap), b = rows_for(waveform, more, tap);
    if (a.empty() || b.empty()) return nan;
    return relative_difference(rows_from(a, from, rate), rows_from(b, from, rate), rate,
                               measures()[waveform].window);
}

// Accuracy of the solution: the certificate's figure, else the noise floor, because rounding errors
// grow like a change at the start. The effect of the modes left out is estimated from the
// doublings.
Trust trust_of(const Trust& solved, const Truth& truth, const Size& of, double from) {
    Trust t = solved;
    const Reference &last = truth.reference, &before = truth.coarser.back();
    const Trace &more = last.run.trace, &fewer = before.run.trace;
    const auto taps = static_cast<std::size_t>(more.taps());
    if (!t.any()) t.figure.assign(taps, Trust::unknown);
    const double until =
        static_cast<double>(std::min(more.rows, fewer.rows) - 1) / more.tap_rate - from;
    t.left_out.assign(taps, Trust::unknown);
    for (std::size_t k = 0; k < taps; ++k)
        for (std::size_t w = 0; w < Trust::columns.size(); ++w) {
            const double end = measures()[w].window;
            if (std::isfinite(end) && end > until + 1e-6) continue;
            const auto apart = [&](const Trace& a, const Trace& b) {
                return change(b, a, static_cast<int>(k), from, w);
            };
            // also for windows beyond the certificate
            if (std::isnan(t.figure[k][w])) t.figure[k][w] = apart(more, last.moved.trace);
            t.left_out[k][w] = left_out(truth, apart, t.figure[k][w]);
        }
    t.doubled = of.points == 0                                               ? "modes"
                : last.choice.settings.modes == before.choice.settings.modes ? "points"
                                                                             : "modes and points";
    return t;
}

// Runs own modes beside a matched reference: two extrapolations, from as many modes and from half
// as many.
std::vector<Trace> own_motion(const ReferenceChoice& matched, const Scene& scene, const Size& size,
                              int jobs, const store::Listener& listener, double time_limit) {
    ReferenceChoice own = matched;
    std::erase_if(own.settings.options,
                  [](const auto& o) { return o.first == compliance_option.name; });
    std::vector<Trace> runs, result;
    for (int part = 1; part <= 4; part *= 2) {
        if (size.modes / part < 1) return {};
        own.settings.modes = size.modes / part;
        runs.push_back(run_reference({own}, scene, jobs, listener, {time_limit}, true).run.trace);
    }
    for (std::size_t k = 0; k < 2; ++k) {
        Trace& t = result.emplace_back(runs[k]);
        t.rows = std::min(runs[k].rows, runs[k + 1].rows);
        for (int tap = 0; tap < t.columns(); ++tap)
            std::ranges::copy(extrapolated(runs[k].column(tap), runs[k + 1].column(tap)),
                              t.tap.begin() + tap * t.stride);
    }
    return result;
}

double left_out(const Truth& t, const Apart& apart, double solved_to) {
    std::vector<double> changes;
    for (std::size_t n = 0; n < t.coarser.size(); ++n)
        changes.push_back(
            apart(t.coarser[n].run.trace,
                  (n + 1 < t.coarser.size() ? t.coarser[n + 1] : t.reference).run.trace));
    if (changes.empty()) return nan;
    double left = left_after(changes, t.matched);
    // Changes below the accuracy of both solutions do not grow.
    if (std::isnan(left) && changes.back() <= solved_to)
        left = left_after({&changes.back(), 1}, t.matched);
    return t.own.empty()
               ? left
               : no_less(left, apart(t.own[0], t.reference.run.trace), apart(t.own[1], t.own[0]));
}

const Reference* of_modes(const Cell& cell, const Reference& model, const Truth& truth) {
    const int modes = cell.settings.modes == 0 ? model.choice.settings.modes : cell.settings.modes;
    const bool matched = is_matched(cell.settings.options);
    const auto is_model = [&](const Reference& r) {
        return r.choice.settings.modes == modes && is_matched(r.choice.settings.options) == matched;
    };
    for (const Reference& r : truth.coarser)
        if (is_model(r)) return &r;
    if (is_model(truth.reference)) return &truth.reference;
    return is_model(model) || (model.choice.settings.modes == modes && !matched) ? &model : nullptr;
}

}  // namespace jvari::bench::study
