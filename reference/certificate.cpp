#include "reference/certificate.hpp"

#include <algorithm>

#include "reference/oversampled.hpp"
#include "reference/profile_points.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"

namespace jvari {

namespace {
constexpr int multiple = 4;  // of the coarsest of the oversampled runs

using Options = Certificate::Options;

struct Job {
    const Descriptor* scheme;
    Options options;
    bool oversampled;
    std::string doubled = {};
};

Confirmation confirmation_of(const Descriptor& reference, const Scene& scene) {
    return reference.confirmation ? reference.confirmation(scene) : Confirmation{};
}

double finest_rate(const CertifySettings& settings) {  // of the oversampled runs
    return 64 * settings.tap_rate;
}

Settings coarsest(const CertifySettings& settings) {
    return {finest_rate(settings) / multiple, settings.tap_rate, settings.modes, {}};
}

std::vector<Job> jobs_for(const Scene& scene, const CertifySettings& settings) {
    std::vector<const Descriptor*> able;
    for (const Descriptor& r : references())
        if (represents(r, scene)) able.push_back(&r);
    std::vector<Job> jobs;
    for (const Descriptor* r : able)
        for (const Options& o : confirmation_of(*r, scene).accuracies)
            jobs.push_back({r, o, false});
    if (!able.empty())
        for (const Options& o : confirmation_of(*able.front(), scene).accuracies)
            if (const auto nearer = matched(*able.front(), scene, o))
                jobs.push_back({able.front(), *nearer, false});
    if (able.size() == 1)
        for (const Options& o : confirmation_of(*able.front(), scene).other_methods)
            jobs.push_back({able.front(), o, false});
    if (jobs.empty())
        if (const Descriptor* scheme =
                best_by_estimate(stand_ins(scene), scene, coarsest(settings), multiple))
            jobs.push_back({scheme, {}, true});
    if (jobs.empty())
        throw Refusal("no reference and no scheme represents scene " + scene.name + ": it needs " +
                      names_of(needed_by(scene)));
    if (!able.empty()) {
        jobs.push_back(
            {able.front(), matched(*able.front(), scene, {}).value_or(Options{}), false, "modes"});
        if (needed_by(scene).any(any_profile))
            jobs.push_back(
                {able.front(),
                 {{nodes_option.name, std::to_string(2 * std::stoi(nodes_option.fallback))}},
                 false,
                 "points"});
    }
    return jobs;
}

Certificate head(const Scene& scene, const CertifySettings& settings) {
    Certificate c;
    c.scene = scene.name;
    c.tap_rate = settings.tap_rate;
    c.duration = scene.duration;
    if (const double from = free_from(scene); from < c.duration) c.from = from;
    for (const Tap& tap : scene.taps) c.taps.push_back(tap.name);
    c.modes = modes_for(scene, {0, settings.tap_rate, settings.modes, {}});
    return c;
}

Certificate::Entry entry_of(const Job& job, const CertifySettings& settings) {
    Certificate::Entry e;
    e.reference = (job.oversampled ? "oversampled " : "") + std::string(job.scheme->name);
    e.options = job.options;
    if (job.oversampled) e.sample_rate = finest_rate(settings);
    e.doubled = job.doubled;
    return e;
}

bool is_default(const Job& job) {
    return (job.options.empty() || (job.options.size() == 1 && is_matched(job.options))) &&
           job.doubled.empty() && !job.oversampled;
}

bool are_compared(const Job& a, const Job& b) {
    if (a.doubled.empty())
        return b.doubled.empty() && is_matched(a.options) == is_matched(b.options);
    return a.scheme == b.scheme && is_default(b);
}

struct Ran {
    int entry;
    const Job* job;
    Trace trace;
};
}  // namespace

Scene moved(Scene scene, double factor) {
    for (String& s : scene.strings) {
        if (s.initial) std::visit([&](auto& shape) { shape.amplitude *= factor; }, *s.initial);
        if (s.pluck) s.pluck->amplitude *= factor;
    }
    return scene;
}

Certificate certificate_plan(const Scene& scene, const CertifySettings& settings) {
    Certificate c = head(scene, settings);
    for (const Job& job : jobs_for(scene, settings)) c.entries.push_back(entry_of(job, settings));
    return c;
}

Certificate certify(const Scene& scene, const CertifySettings& settings) {
    Certificate c = head(scene, settings);
    const std::vector<Job> jobs = jobs_for(scene, settings);
    std::vector<Ran> ran;
    int done = 0;
    RunOptions options;
    if (settings.within)
        options.progress = [&settings](long rows, long of) {
            settings.within(static_cast<double>(rows) / static_cast<double>(of));
        };
    const auto announce = [&](const std::string& name) {
        if (settings.progress) settings.progress(name, done, static_cast<int>(jobs.size()) + 1);
        ++done;
    };
    const auto settings_of = [&](const Job& job) {
        return Settings{job.oversampled ? finest_rate(settings) : 0, settings.tap_rate,
                        job.doubled == "modes" ? 2 * c.modes : c.modes, job.options};
    };
    for (const Job& job : jobs) {
        Certificate::Entry entry = entry_of(job, settings);
        announce(entry.reference);
        try {
            Run r;
            Settings own = settings_of(job);
            if (job.oversampled) {
                own.sample_rate /= multiple;
                Oversampled o = oversampled(*job.scheme, scene, own, multiple, options);
                for (const auto& tap : o.estimates) {
                    auto& by_window = entry.estimate.emplace_back();
                    for (std::size_t w = 0; w < by_window.size(); ++w) by_window[w] = tap[w].error;
                }
                entry.sample_rate = o.rate;
                entry.wall_seconds = o.wall_seconds;
                r = std::move(o.run);
            } else {
                r = run(*job.scheme, scene, own, options);
                entry.wall_seconds = r.wall_seconds;
            }
            entry.status = r.status;
            entry.reached = static_cast<double>(std::max(0L, r.trace.rows - 1)) / settings.tap_rate;
            ran.push_back({static_cast<int>(c.entries.size()), &job, std::move(r.trace)});
        } catch (const Refusal& refusal) {
            entry.reason = refusal.what();
        } catch (const BadScene& e) {
            if (job.doubled.empty()) throw;
            entry.reason = e.what();  // it has no more modes than that: those that were measured
        }
        c.entries.push_back(std::move(entry));
    }
    if (ran.empty())
        throw Refusal("certificate of scene " + scene.name +
                      ": every reference refuses it; the first: " + c.entries.front().reason);

    const auto compare = [&](const Trace& a, const Trace& b) {
        std::vector<Agreement> taps;
        const auto free = [&](const Trace& t, int k) {
            return rows_from(t.column(k), c.from, t.tap_rate);
        };
        for (int k = 0; k < b.taps(); ++k)
            taps.push_back(agreement(free(a, k), free(b, k), settings.tap_rate));
        return taps;
    };
    for (std::size_t a = 0; a < ran.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            if (are_compared(*ran[a].job, *ran[b].job))
                c.pairs.push_back(
                    {ran[a].entry, ran[b].entry, compare(ran[a].trace, ran[b].trace)});

    announce("noise floor");
    const Job& first = *ran.front().job;
    c.floor = compare(
        run(*first.scheme, moved(scene, 1 + floor_displacement), settings_of(first), options).trace,
        ran.front().trace);
    return c;
}

}  // namespace jvari
