#include "bench/study/truth.hpp"

#include <algorithm>
#include <map>

#include "bench/study/errors.hpp"
#include "reference/agreement.hpp"
#include "reference/profile_points.hpp"
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

std::vector<Doubling> doublings(const Truth& t, bool points) {
    struct Sized {
        const Reference* run;
        int doubled, other;  // numbers of modes and points, or of points and modes
    };
    std::vector<Sized> all;
    const auto add = [&](const Reference& r) {
        const Settings& s = r.choice.settings;
        const int count = t.has_points ? profile_points(s).count : 0;
        all.push_back(points ? Sized{&r, count, s.modes} : Sized{&r, s.modes, count});
    };
    for (const Reference& r : t.coarser) add(r);
    add(t.reference);
    std::ranges::sort(all, {}, &Sized::other);
    std::map<int, Doubling> found;  // by the coarse number
    for (const Sized& coarse : all)
        for (const Sized& fine : all)
            if (fine.other == coarse.other && fine.doubled > coarse.doubled &&
                fine.doubled <= 2 * coarse.doubled + 1)
                found[coarse.doubled] = {coarse.run, fine.run};
    std::vector<Doubling> in_order;
    for (const auto& [number, doubling] : found) in_order.push_back(doubling);
    return in_order;
}

bool ends_at_reference(const std::vector<Doubling>& steps, const Truth& t) {
    return !steps.empty() && steps.back().fine == &t.reference;
}

double left_by(const std::vector<Doubling>& steps, bool matched, const Apart& apart,
               double solved_to) {
    std::vector<double> changes;
    for (const auto& [coarse, fine] : steps)
        changes.push_back(apart(coarse->run.trace, fine->run.trace));
    const double left = left_after(changes, matched);
    // Changes below the accuracy of both solutions do not grow.
    return std::isnan(left) && !changes.empty() && changes.back() <= solved_to
               ? left_after({&changes.back(), 1}, matched)
               : left;
}

// Accuracy of the solution: the certificate's figure, else the noise floor, because rounding errors
// grow like a change at the start. The effect of the modes left out is estimated from the
// doublings.
Trust trust_of(const Trust& solved, const Truth& truth, double from) {
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
    t.doubled = !truth.has_points ? "modes" : truth.all_modes ? "points" : "modes and points";
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
    const auto left = [&](bool points) {
        const auto steps = doublings(t, points);
        return ends_at_reference(steps, t) ? left_by(steps, t.matched, apart, solved_to) : nan;
    };
    const double by_modes = t.all_modes && t.has_points ? 0 : left(false),
                 both = t.has_points ? by_modes + left(true) : by_modes;
    return t.own.empty()
               ? both
               : no_less(both, apart(t.own[0], t.reference.run.trace), apart(t.own[1], t.own[0]));
}

const Reference* of_modes(const Cell& cell, const Reference& model, const Truth& truth) {
    const int modes = cell.settings.modes == 0 ? model.choice.settings.modes : cell.settings.modes;
    const bool matched = is_matched(cell.settings.options);
    const auto is_model = [&](const Reference& r) {
        return r.choice.settings.modes == modes && is_matched(r.choice.settings.options) == matched;
    };
    if (is_model(truth.reference)) return &truth.reference;
    // of a profile: the one with most points
    const auto found = std::find_if(truth.coarser.rbegin(), truth.coarser.rend(), is_model);
    if (found != truth.coarser.rend()) return &*found;
    return is_model(model) || (model.choice.settings.modes == modes && !matched) ? &model : nullptr;
}

}  // namespace jvari::bench::study
