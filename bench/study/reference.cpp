#include "bench/study/reference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <span>

#include "bench/store/system/interruption.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/study/cell.hpp"
#include "bench/study/kept_run.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"

namespace jvari::bench::study {

namespace {
ProgressOf told_to(store::Done& done) {
    return
        [&done](long rows, long of) { done = static_cast<double>(rows) / static_cast<double>(of); };
}

Run reference_run(const ReferenceChoice& choice, const Scene& scene, const ProgressOf& progress) {
    const auto make = [&] {
        return run(*choice.scheme, scene, choice.settings, {.progress = progress});
    };
    if (!choice.kept) return make();
    const std::string key = run_key(*choice.scheme, scene, choice.settings);
    const auto cached = [&] { return kept_run(kept_runs_folder(), key, make); };
    return choice.kept_in.empty() ? cached() : kept_run(choice.kept_in, key, cached, 0);
}

double last_instant(const Run& r) {
    return static_cast<double>(r.trace.rows - 1) / r.trace.tap_rate;
}

// A scheme at three rates, the highest of them those of `r.choice`: its run there and its own
// estimate.
void run_oversampled(Reference& r, const Scene& scene, const ProgressOf& progress) {
    Settings coarsest = r.choice.settings;
    coarsest.sample_rate /= r.choice.oversampled;
    try {
        Oversampled o = oversampled(*r.choice.scheme, scene, coarsest, r.choice.oversampled,
                                    {.progress = progress});
        if (o.rate == r.choice.settings.sample_rate) {
            r.run = std::move(o.run);
            r.trust = trust_of(o, last_instant(r.run) - free_from(scene));
            return;
        }
        r.trust.missing = fmt::format("at {:.6g} Hz it {}", o.rate, name_of(o.run.status.outcome));
    } catch (const Refusal& e) { r.trust.missing = e.what(); }
    r.run = reference_run(r.choice, scene, progress);  // a coarser one fails: no estimate
}

// Schemes that may stand in, in order of what they estimate their own error to be.
void least_error_first(std::span<ReferenceChoice> choices, const Scene& scene,
                       const ProgressOf& progress) {
    std::vector<std::pair<double, ReferenceChoice>> tried;
    for (ReferenceChoice& c : choices) {
        Settings coarsest = c.settings;
        coarsest.sample_rate /= c.oversampled;
        tried.emplace_back(
            estimate_of(*c.scheme, scene, coarsest, c.oversampled, {.progress = progress}),
            std::move(c));
    }
    std::ranges::stable_sort(tried, {}, [](const auto& t) { return t.first; });
    for (std::size_t i = 0; i < tried.size(); ++i) choices[i] = std::move(tried[i].second);
}
}  // namespace

std::vector<ReferenceChoice> references_of(const Scene& scene, const Settings& at,
                                           const Descriptor* named, const Descriptor* stand_in) {
    std::vector<ReferenceChoice> all;
    const auto add = [&](const Descriptor& d, const std::string& note) {
        const bool solver = std::ranges::any_of(references(), [&d](auto& r) { return &r == &d; });
        const bool continuous = d.clock == Clock::continuous;
        const int multiple = solver || continuous ? 0 : oversampling;
        ReferenceChoice& c = all.emplace_back(ReferenceChoice{&d, at, note, multiple, solver});
        c.settings.sample_rate *= continuous ? 0 : std::max(1, multiple);
    };
    if (named) {
        add(*named, "");
        return all;
    }
    for (const Descriptor* d : jvari::references_of(scene)) add(*d, "");
    if (!stand_in) return all;
    auto able = stand_ins(scene);
    if (able.empty()) able.push_back(stand_in);
    const std::string why = all.empty() ? "no reference represents scene " + scene.name
                                        : "no reference gets scene " + scene.name + " going";
    for (const Descriptor* scheme : able)
        add(*scheme,
            fmt::format("{}: {} oversampled to {} Hz, {} times the highest rate, stands in; its "
                        "error is estimated from three rates, "
                        "not bounded{}",
                        why, scheme->name, oversampling * at.sample_rate, oversampling,
                        able.size() > 1 ? ", and was the least of those that could" : ""));
    return all;
}

Reference run_reference(const std::vector<ReferenceChoice>& choices, const Scene& scene, int jobs,
                        const store::Listener& listener, double time_limit, bool alone) {
    if (const double from = free_from(scene); from >= scene.duration && !alone)
        throw Refusal(fmt::format(
            "a pluck of {} ends at {:.6g} s, and the run at {:.6g} s: errors are measured once "
            "nothing pushes the string any "
            "more, so there is nothing to measure; a --duration of {:.6g} covers the first 50 ms",
            scene.name, from, scene.duration, from + 50e-3));
    std::string refusals;
    bool ordered = false;
    std::vector<ReferenceChoice> in_turn = choices;
    for (std::size_t k = 0; k < in_turn.size(); ++k) try {
            if (in_turn[k].oversampled && k + 1 < in_turn.size() && !ordered) {
                const std::span<ReferenceChoice> rest(in_turn.begin() + static_cast<long>(k),
                                                      in_turn.end());
                store::side_by_side(
                    {1}, 1, listener, "stand-in", [&](std::size_t, store::Done& done) {
                        least_error_first(rest, scene, store::within(time_limit, told_to(done)));
                    });
                ordered = true;
            }
            const ReferenceChoice& choice = in_turn[k];
            Reference r{choice, {}, {}, {}};
            store::side_by_side(std::vector<double>(alone ? 1 : 2, 1), jobs, listener, "reference",
                                [&](std::size_t i, store::Done& done) {
                                    const ProgressOf progress =
                                        store::within(time_limit, told_to(done));
                                    if (i == 1)
                                        r.moved = reference_run(
                                            choice, moved(scene, 1 + floor_displacement), progress);
                                    else if (choice.oversampled)
                                        run_oversampled(r, scene, progress);
                                    else r.run = reference_run(choice, scene, progress);
                                });
            if (r.run.trace.rows < 2) {
                refusals += fmt::format("; {} failed at its start", choice.scheme->name);
                continue;
            }
            if (alone && r.run.status.outcome != Outcome::ok) {
                refusals +=
                    fmt::format("; {} {}", choice.scheme->name, name_of(r.run.status.outcome));
                continue;
            }
            if (!choice.oversampled && !alone)
                r.trust =
                    trust_of(scene, choice.scheme->name, choice.settings, last_instant(r.run));
            return r;
        } catch (const Refusal& e) {
            refusals += std::string("; ") + e.what();
        } catch (const store::PastItsLimit& e) {
            throw store::PastItsLimit(fmt::format("reference {}: {}", in_turn[k].name(), e.what()));
        }
    throw Refusal("reference: none represents scene " + scene.name + refusals);
}

}  // namespace jvari::bench::study
