#include "bench/suite/suite.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/compare/compare_plan.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/suite/maps.hpp"
#include "reference/agreement.hpp"
#include "scenes/modes.hpp"

namespace jvari::bench::suite {

namespace {
using Json = nlohmann::ordered_json;

constexpr double most_of_rate = 0.49;  // highest mode of a population's string over the rate

// Adds the measurements on a job's accuracy run (spectrogram and sound), and describes them in
// JSON.
void add_facets(study::Job& job, const CellSet& set, int tap) {
    Json measured = Json::array();
    for (const Facet& f : facets())
        if (set.measures(f.name)) measured.push_back(f.name);
    if (set.measures(measured::spectrogram) || set.measures(measured::sound))
        measured.push_back({{"tap", job.point->scene.taps.at(tap).name}});
    job.measured = store::compact(measured);
    job.measure = [&set, tap](const study::Ran& ran, study::Record& into) {
        if (set.measures(measured::spectrogram))
            into.levels = study::levels_of(ran.trace.column(tap), ran.trace.tap_rate);
        if (set.measures(measured::sound)) keep_sounds(ran, into);
    };
}

// Adds a string from a population: one point with all modes and options. Leaves out modes that a
// rate cannot hold, but keeps the smallest number. The first job examines the string if the set
// measures `share`.
void add_string(study::Plan& plan, const compare::CompareRequest& r, const CellSet& set,
                const compare::Catalogue& catalogue, study::Point& common, study::Job& like) {
    common.begin = 0;
    common.in_model = false;
    common.effort = set.effort;
    common.settles_whole = true;
    like.errors = {study::measure("error_l2_whole")};
    const std::size_t from = plan.jobs.size(), notes = plan.notes.size();
    compare::add_jobs(plan, r, catalogue, common, like);
    plan.notes.resize(notes);  // the notes repeat for each string
    const auto carried = [&](const study::Job& job) {
        const int modes = job.cell.settings.modes;
        return modes == set.modes.front() ||
               modes <= modes_below(set.drawn->strings.front(),
                                    most_of_rate * job.cell.settings.sample_rate);
    };
    plan.jobs.erase(std::stable_partition(plan.jobs.begin() + static_cast<long>(from),
                                          plan.jobs.end(), carried),
                    plan.jobs.end());
    if (plan.jobs.size() == from || !set.measures(measured::share)) return;
    plan.jobs[from].measured += " beside";
    plan.jobs[from].beside = [catalogue](const study::Point& p, const study::Truth* truth) {
        return examined(p, truth, catalogue);
    };
}

// Gives a swept key its value. A map has the values in the order x, y, whichever varies first.
void assign(SuitePoint& p, const std::string& key, const std::string& value) {
    compare::CompareRequest& r = p.request;
    const bool on_map = p.set->measures(measured::outcome);
    const double number = store::number_of(value);
    p.swept.emplace(on_map ? p.swept.begin() : p.swept.end(), key, value);
    if (on_map && key == "rate") r.rates = {number};
    else if (on_map && key == "modes") r.modes = {static_cast<int>(number)};
    else if (on_map && key == "duration") r.duration = number;
    else if (on_map && key == "amplitude") p.amplitude = number;
    else if (on_map && is_option(key))
        r.options.push_back(compare::SchemeOption::of(key.substr(7), value));
    else r.set.push_back(key + "=" + value);
}

// Adds a point of a map, with a job for each scheme. Without named schemes these are all that
// represent the scene as the library has it; at some points they refuse.
void add_outcomes(study::Plan& plan, const SuitePoint& p, const compare::Catalogue& catalogue,
                  const study::Job& like) {
    const compare::CompareRequest& r = p.request;
    Settings settings;
    settings.sample_rate = r.rates.empty() ? 44100 : r.rates.front();
    settings.tap_rate = row_rate(settings.sample_rate);
    settings.modes = r.modes.empty() ? 0 : r.modes.front();
    study::Point& point = plan.points.emplace_back(
        judged_point(catalogue, moved(like.point->scene, p.amplitude), settings, r.reference,
                     r.reference_modes.value_or(0)));
    point.swept = p.swept;
    point.time_limit = like.point->time_limit;
    const Scene own = compare::load_scene(r.scene, {}, std::nullopt);
    for (const Descriptor* d : compare::schemes_for(r, catalogue, own)) {
        settings.options.clear();
        for (const compare::SchemeOption& o : r.options)
            if (o.scheme.empty() || o.scheme == d->name)
                settings.options.emplace_back(o.name, o.value);
        study::Job& job = plan.jobs.emplace_back(judged_job(*d, point, settings));
        job.set = like.set;
        job.measured = "outcome on " + p.set->name;  // two maps may have a point in common
    }
}
}  // namespace

std::vector<SuitePoint> points_of(const std::vector<CellSet>& sets) {
    std::vector<SuitePoint> all;
    for (const CellSet& set : sets) {
        std::vector<SuitePoint> points{{&set, set}};
        points.front().request.controls = true;
        // leaves the points unchanged if there are no values
        const auto vary = [&points](const auto& values, const auto& apply) {
            if (values.empty()) return;
            std::vector<SuitePoint> more;
            for (const SuitePoint& p : points)
                for (const auto& value : values) apply(more.emplace_back(p), value);
            points = std::move(more);
        };
        if (set.drawn) {
            compare::CompareRequest& r = points.front().request;
            r.scene = set.drawn->name;
            for (const VariedOption& o : set.varied)
                for (const std::string& value : o.values)
                    r.options.emplace_back(o.option).value = value;
            all.push_back(points.front());
            continue;
        }
        vary(set.scenes, [](SuitePoint& p, const std::string& scene) { p.request.scene = scene; });
        vary(set.modes, [](SuitePoint& p, int modes) { p.request.modes = {modes}; });
        const auto sweep = [&vary](const SweptKey& k) {
            vary(k.values,
                 [&k](SuitePoint& p, const std::string& value) { assign(p, k.key, value); });
        };
        if (set.measures(measured::outcome))
            std::for_each(set.sweep.rbegin(), set.sweep.rend(), sweep);
        else std::ranges::for_each(set.sweep, sweep);
        for (const VariedOption& o : set.varied)
            vary(o.values, [&o](SuitePoint& p, const std::string& value) {
                p.request.options.emplace_back(o.option).value = value;
            });
        all.insert(all.end(), points.begin(), points.end());
    }
    return all;
}

std::vector<Advised> advice_of(const Suite& suite, const compare::Catalogue& catalogue,
                               const store::Listener& listener) {
    std::vector<Advised> all;
    for (const SuitePoint& p : points_of(suite.sets)) {
        const bool known = std::ranges::any_of(all, [&p](const Advised& a) {
            return a.set == p.set && a.scene_words == p.request.scene;
        });
        if (known || !p.set->measures(measured::advice)) continue;
        const Scene scene = compare::load_scene(p.request);
        if (auto a = compare::advice_on(scene, p.request, catalogue, listener))
            all.push_back({p.set, p.request.scene, scene.name, *std::move(a)});
    }
    return all;
}

std::string verdicts_on(std::span<const Advised> advised, const study::Cells& cells) {
    std::string text;
    for (const Advised& a : advised) {
        study::Cells own;
        for (const study::TabledCell& c : cells)
            if (c.scene == a.scene) own.push_back(c);
        text += fmt::format("{}advice on {}: {}; {}", text.empty() ? "" : "\n", a.scene,
                            compare::short_text(a.advice), compare::verdict_on(a.advice, own).text);
    }
    return text;
}

study::Plan plan_of(const std::vector<CellSet>& sets, const compare::Catalogue& catalogue,
                    const std::vector<std::string>& plugins, std::span<const Advised> advised) {
    study::Plan all;
    for (const SuitePoint& point : points_of(sets)) {
        const CellSet& set = *point.set;
        const compare::CompareRequest& r = point.request;
        const std::string where =
            set.name.empty() ? "scene " + r.scene + ": " : "map " + set.name + ": ";
        study::Point common;
        common.scene = set.drawn ? *set.drawn : compare::load_scene(r);
        common.time_limit = set.time_limit.value_or(HUGE_VAL);
        // common reference for a sweep over modes
        common.begin = set.modes.empty() ? 0 : *std::ranges::max_element(set.modes);
        common.swept = point.swept;
        study::Job like{&common, {}};
        like.judged = set.measures(measured::errors);
        like.repeats = set.measures(measured::cost) ? set.repeats : 0;
        like.set = static_cast<int>(&set - sets.data());
        try {
            if (set.measures(measured::outcome)) {
                add_outcomes(all, point, catalogue, like);
                continue;
            }
            common.scene.taps.insert(common.scene.taps.end(), set.taps.begin(), set.taps.end());
            validate(common.scene);
            add_facets(like, set, compare::tap_named(common.scene, set.tap));
            if (set.drawn) add_string(all, r, set, catalogue, common, like);
            else compare::add_jobs(all, r, catalogue, common, like);
            for (const Advised& a : advised) {
                if (a.set != &set || a.scene_words != r.scene || !a.advice.scheme) continue;
                study::Job& job = all.jobs.emplace_back(like);
                job.point = &all.points.back();
                job.cell = {a.advice.scheme, a.advice.settings};
            }
        } catch (const store::UsageError& e) {
            throw store::UsageError(where + e.what());
        } catch (const Refusal& e) { throw Refusal(where + e.what()); }
    }
    study::address(all, store::program_identity(plugins));
    return all;
}

}  // namespace jvari::bench::suite
