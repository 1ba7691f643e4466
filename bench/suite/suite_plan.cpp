#include "bench/suite/suite.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/compare/compare_plan.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
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
}  // namespace

std::vector<SuitePoint> points_of(const Suite& suite) {
    std::vector<SuitePoint> points;
    for (const CellSet& set : suite.sets) {
        std::vector<compare::CompareRequest> requests{set};
        requests.front().controls = true;
        // leaves the requests unchanged if there are no values
        const auto vary = [&requests](const auto& values, const auto& apply) {
            if (values.empty()) return;
            std::vector<compare::CompareRequest> more;
            for (const compare::CompareRequest& r : requests)
                for (const auto& value : values) apply(more.emplace_back(r), value);
            requests = std::move(more);
        };
        using Request = compare::CompareRequest;
        if (set.drawn) {
            Request& r = requests.front();
            r.scene = set.drawn->name;
            for (const VariedOption& o : set.varied)
                for (const std::string& value : o.values)
                    r.options.emplace_back(o.option).value = value;
            points.push_back({&set, r});
            continue;
        }
        vary(set.scenes, [](Request& r, const std::string& scene) { r.scene = scene; });
        vary(set.modes, [](Request& r, int modes) { r.modes = {modes}; });
        for (const SweptKey& k : set.sweep)
            vary(k.values, [&k](Request& r, const std::string& value) {
                r.set.push_back(k.key + "=" + value);
            });
        for (const VariedOption& o : set.varied)
            vary(o.values, [&o](Request& r, const std::string& value) {
                r.options.emplace_back(o.option).value = value;
            });
        for (const Request& r : requests) points.push_back({&set, r});
    }
    return points;
}

std::vector<Advised> advice_of(const Suite& suite, const compare::Catalogue& catalogue,
                               const store::Listener& listener) {
    std::vector<Advised> all;
    for (const SuitePoint& p : points_of(suite)) {
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

study::Plan plan_of(const Suite& suite, const compare::Catalogue& catalogue,
                    const std::vector<std::string>& plugins, std::span<const Advised> advised) {
    study::Plan all;
    for (const SuitePoint& point : points_of(suite)) {
        const CellSet& set = *point.set;
        const compare::CompareRequest& r = point.request;
        const std::string where = "scene " + r.scene + ": ";
        study::Point common;
        common.scene = set.drawn ? *set.drawn : compare::load_scene(r);
        common.time_limit = set.time_limit.value_or(HUGE_VAL);
        // common reference for a sweep over modes
        common.begin = set.modes.empty() ? 0 : *std::ranges::max_element(set.modes);
        for (const std::string& assignment : r.set) {
            const auto equals = assignment.find('=');
            common.swept.emplace_back(assignment.substr(0, equals), assignment.substr(equals + 1));
        }
        study::Job like{&common, {}};
        like.judged = set.measures(measured::errors);
        like.repeats = set.measures(measured::cost) ? set.repeats : 0;
        like.set = static_cast<int>(&set - suite.sets.data());
        try {
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
