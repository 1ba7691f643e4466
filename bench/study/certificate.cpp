#include "bench/study/certificate.hpp"

#include <fmt/core.h>
#include <algorithm>

#include "bench/store/records.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/study/reference.hpp"
#include "reference/oversampled.hpp"
#include "reference/profile_points.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::study {

namespace {
constexpr int multiple = 4;  // highest rate over the coarsest, in the oversampled runs

using Entry = Certificate::Entry;

double finest_rate(double tap_rate) { return 64 * tap_rate; }  // highest rate for oversampled runs

std::vector<Entry> entries_for(const Scene& scene, const CertifySettings& settings) {
    const std::vector<const Descriptor*> able = references_of(scene);
    const auto confirmation_of = [&scene](const Descriptor& d) {
        return d.confirmation ? d.confirmation(scene) : Confirmation{};
    };
    std::vector<Entry> entries;
    const auto add = [&](const Descriptor* d, Certificate::Options options,
                         const char* doubled = "") {
        entries.push_back({d->name, std::move(options), 0, {}, 0, 0, {}, {}, doubled, d});
    };
    for (const Descriptor* r : able)
        for (const auto& o : confirmation_of(*r).accuracies) add(r, o);
    if (!able.empty()) {
        const Descriptor* first = able.front();
        for (const auto& o : confirmation_of(*first).accuracies)
            if (const auto nearer = matched(*first, scene, o)) add(first, *nearer);
        if (able.size() == 1)
            for (const auto& o : confirmation_of(*first).other_methods) add(first, o);
    }
    if (entries.empty()) {
        const double finest = finest_rate(settings.tap_rate);
        const Settings coarsest{finest / multiple, settings.tap_rate, settings.modes, {}};
        const Descriptor* d = best_by_estimate(stand_ins(scene), scene, coarsest, multiple);
        if (!d)
            throw Refusal("no reference and no scheme represents scene " + scene.name +
                          ": it needs " + names_of(needed_by(scene)));
        add(d, {});
        entries.back().reference = std::string("oversampled ") + d->name;
        entries.back().sample_rate = finest;
    }
    if (able.empty()) return entries;
    add(able.front(), matched(*able.front(), scene, {}).value_or(Certificate::Options{}), "modes");
    if (needed_by(scene).any(any_profile))
        add(able.front(),
            {{nodes_option.name, std::to_string(2 * std::stoi(nodes_option.fallback))}}, "points");
    return entries;
}

bool is_default(const Entry& e) {
    return (e.options.empty() || (e.options.size() == 1 && is_matched(e.options))) &&
           e.doubled.empty() && !e.oversampled();
}

bool are_compared(const Entry& a, const Entry& b) {
    if (a.doubled.empty())
        return b.doubled.empty() && is_matched(a.options) == is_matched(b.options);
    return a.scheme == b.scheme && is_default(b);
}

Settings settings_of(const Certificate& c, const Entry& e) {
    return {e.oversampled() ? finest_rate(c.tap_rate) : 0, c.tap_rate,
            e.doubled == "modes" ? 2 * c.modes : c.modes, e.options};
}

// Runs the entry, fills in its results and returns its trace.
Trace run_entry(Entry& e, const Certificate& c, const Scene& scene, const RunOptions& options,
                const std::filesystem::path& runs) {
    Settings own = settings_of(c, e);
    Run r;
    if (e.oversampled()) {
        own.sample_rate /= multiple;
        Oversampled o = oversampled(*e.scheme, scene, own, multiple, options);
        e.estimate = o.estimates;
        e.sample_rate = o.rate;
        e.wall_seconds = o.wall_seconds;
        r = std::move(o.run);
    } else {
        r = kept_run(runs, run_key(*e.scheme, scene, own),
                     [&] { return run_heard(*e.scheme, scene, own, options); });
        e.wall_seconds = r.wall_seconds;
    }
    e.status = r.status;
    e.reached = static_cast<double>(std::max(0L, r.trace.rows - 1)) / c.tap_rate;
    return std::move(r.trace);
}

std::vector<Agreement> compared(const Certificate& c, const Trace& a, const Trace& b) {
    std::vector<Agreement> taps;
    const auto free = [&c](const Trace& t, int k) {
        return rows_from(t.column(k), c.from, t.tap_rate);
    };
    for (int k = 0; k < b.taps(); ++k)
        taps.push_back(agreement(free(a, k), free(b, k), c.tap_rate));
    return taps;
}
}  // namespace

std::string Certificate::Entry::name() const {
    return store::variant_name(reference, store::options_text(options));
}

std::string timeless_hash(const Scene& scene) {
    Scene timeless = scene;
    timeless.duration = 1;
    return jvari::scene_hash(timeless);
}

Certificate certificate_plan(const Scene& scene, const CertifySettings& settings) {
    Certificate c;
    c.scene = scene.name;
    c.scene_hash = timeless_hash(scene);
    c.tap_rate = settings.tap_rate;
    c.duration = scene.duration;
    if (const double from = free_from(scene); from < c.duration) c.from = from;
    for (const Tap& tap : scene.taps) c.taps.push_back(tap.name);
    c.modes =
        settings.modes > 0 ? settings.modes : modes_to_begin_with(scene, settings.tap_rate, 0);
    c.entries = entries_for(scene, settings);
    return c;
}

Certificate certify(const Scene& scene, Certificate c, const store::Listener& listener,
                    const std::filesystem::path& runs, double seconds) {
    const TimeLimit limit = first_run(seconds);  // for each run
    const std::size_t count = c.entries.size();
    std::vector<std::optional<Trace>> traces(count);
    const auto work = [&](std::size_t i, store::Done& done) {
        RunOptions options;
        options.progress = store::within(
            limit.seconds,
            [&done](long rows, long of) {
                done = static_cast<double>(rows) / static_cast<double>(of);
            },
            limit.judged_after);
        if (i == count) {  // the noise floor
            const auto ran = std::ranges::find_if(traces, [](const auto& t) { return !!t; });
            if (ran == traces.end())
                throw Refusal(
                    "certificate of scene " + scene.name +
                    ": every reference refuses it; the first: " + c.entries.front().reason);
            const Entry& first = c.entries[static_cast<std::size_t>(ran - traces.begin())];
            const Scene apart = moved(scene, 1 + floor_displacement);
            const Settings own = settings_of(c, first);
            const Run r = kept_run(runs, run_key(*first.scheme, apart, own),
                                   [&] { return run_heard(*first.scheme, apart, own, options); });
            c.floor = compared(c, r.trace, **ran);
            return;
        }
        Entry& e = c.entries[i];
        try {
            traces[i] = run_entry(e, c, scene, options, runs);
        } catch (const Refusal& refusal) {
            e.reason = refusal.what();
        } catch (const store::PastItsLimit&) {
            e.reason = fmt::format("it takes longer than {:g} s", limit.seconds);
        } catch (const BadScene& bad) {
            if (e.doubled.empty()) throw;
            e.reason = bad.what();  // The scene has only so many measured modes.
        }
    };
    store::side_by_side(
        std::vector<double>(count + 1, 1), 1, listener, "certify", work,
        [&](std::size_t i) { return i < count ? c.entries[i].name() : "noise floor"; });
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < a; ++b)
            if (traces[a] && traces[b] && are_compared(c.entries[a], c.entries[b]))
                c.pairs.push_back({static_cast<int>(a), static_cast<int>(b),
                                   compared(c, *traces[a], *traces[b])});
    return c;
}

}  // namespace jvari::bench::study
