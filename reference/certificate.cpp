#include "reference/certificate.hpp"

#include <algorithm>
#include <string_view>

#include "reference/oversampled.hpp"
#include "reference/references.hpp"
#include "scenes/modes.hpp"

namespace jvari {

namespace {
constexpr double displacement_of_floor = 1e-12;

using Options = std::vector<std::pair<std::string, std::string>>;

// Two settings of each reference's own accuracy, the better one first.
std::vector<Options> accuracies(const Descriptor& reference, const Scene& scene) {
    const std::string_view name = reference.name;
    const bool smooth = !needed_by(scene).has(Feature::power_law_contact);
    if (name == "exact_contact") return {{}, {{"window", "0.5"}}};
    if (name == "sundials") return {{{"rtol", smooth ? "1e-12" : "1e-13"}}, {{"rtol", smooth ? "1e-10" : "1e-12"}}};
    return {{}};
}

struct Ran {
    int entry;
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

Certificate certify(const Scene& scene, const CertifySettings& settings) {
    struct Job {
        const Descriptor* scheme;
        Options options;
    };
    std::vector<Job> jobs;
    for (const Descriptor& r : references())
        if ((needed_by(scene) - r.represents).empty())
            for (const Options& o : accuracies(r, scene)) jobs.push_back({&r, o});
    const bool oversample = jobs.empty() || settings.oversampled_rate > 0;
    const Descriptor* scheme = oversample ? stand_in(scene) : nullptr;
    if (jobs.empty() && !scheme)
        throw Refusal("no reference and no scheme represents scene " + scene.name + ": it needs " + names_of(needed_by(scene)));

    Certificate c;
    c.scene = scene.name;
    c.tap_rate = settings.tap_rate;
    c.duration = scene.duration;
    for (const Tap& tap : scene.taps) c.taps.push_back(tap.name);
    Settings s{0, settings.tap_rate, settings.modes, {}};
    c.modes = s.modes = modes_for(scene.strings.at(0), s);

    std::vector<Ran> ran;
    const int total = static_cast<int>(jobs.size()) + (scheme ? 1 : 0) + 1;
    int done = 0;
    const auto announce = [&](const std::string& name) {
        if (settings.progress) settings.progress(name, done, total);
        ++done;
    };
    const auto keep = [&](Certificate::Entry entry, Run r) {
        entry.status = r.status;
        entry.reached = static_cast<double>(std::max(0L, r.trace.rows - 1)) / settings.tap_rate;
        if (entry.wall_seconds == 0) entry.wall_seconds = r.wall_seconds;
        c.entries.push_back(std::move(entry));
        ran.push_back({static_cast<int>(c.entries.size()) - 1, std::move(r.trace)});
    };
    const Job* best = nullptr;
    for (const Job& job : jobs) {
        announce(job.scheme->name);
        Certificate::Entry entry{job.scheme->name, job.options, 0, {}, 0, 0, {}, {}};
        Settings own = s;
        own.options = job.options;
        try {
            keep(entry, run(*job.scheme, scene, own));
            if (!best) best = &job;
        } catch (const Refusal& refusal) {
            entry.reason = refusal.what();
            c.entries.push_back(entry);
        }
    }
    constexpr int multiple = 4;
    const double finest = settings.oversampled_rate > 0 ? settings.oversampled_rate : 64 * settings.tap_rate;
    if (scheme) {
        announce(std::string("oversampled ") + scheme->name);
        Certificate::Entry entry{std::string("oversampled ") + scheme->name, {}, finest, {}, 0, 0, {}, {}};
        Settings own = s;
        own.sample_rate = finest / multiple;
        try {
            Oversampled o = oversampled(*scheme, scene, own, multiple);
            for (const auto& tap : o.estimates) entry.estimate.push_back(tap.back().error);
            entry.wall_seconds = o.wall_seconds;
            keep(entry, std::move(o.run));
        } catch (const Refusal& refusal) {
            entry.reason = refusal.what();
            c.entries.push_back(entry);
        }
    }
    if (ran.empty())
        throw Refusal("certificate of scene " + scene.name + ": every reference refuses it; the first: " + c.entries.front().reason);

    const auto compare = [&](const Trace& a, const Trace& b) {
        std::vector<Agreement> taps;
        for (int k = 0; k < b.taps(); ++k)
            taps.push_back(agreement(a.column(k).first(a.rows), b.column(k).first(b.rows), settings.tap_rate));
        return taps;
    };
    for (std::size_t a = 0; a < ran.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) c.pairs.push_back({ran[a].entry, ran[b].entry, compare(ran[a].trace, ran[b].trace)});

    announce("noise floor");
    Settings own = s;
    if (best) own.options = best->options;
    else own.sample_rate = finest;
    c.floor = compare(run(best ? *best->scheme : *scheme, moved(scene, 1 + displacement_of_floor), own).trace, ran.front().trace);
    return c;
}

}  // namespace jvari
