#include "bench/suite/suite_plan.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/compare/compare_plan.hpp"
#include "bench/store/machine.hpp"
#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

namespace {
using Json = nlohmann::ordered_json;

int tap_of(const CellSet& set, const Scene& scene) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < scene.taps.size(); ++k) {
        if (set.tap.empty() || scene.taps[k].name == set.tap) return static_cast<int>(k);
        names.push_back(scene.taps[k].name);
    }
    throw store::UsageError(store::unknown("tap", set.tap, names));
}

// What one scene of the file is; messages of compare's planner come with its name.
std::vector<compare::Plan> planned(const SuitePoint& asked, const compare::Catalogue& catalogue, study::Point& into) {
    const compare::CompareRequest& r = asked.request;
    const std::string where = "scene " + r.scene + ": ";
    into.scene = compare::load_scene(r.scene, r.set, r.duration);
    into.element = asked.element;
    try {
        if (asked.element) into.scene = study::without(*asked.element, std::move(into.scene));
        into.scene = with_figure_taps(into.scene, asked.set->figures);
        into.taps = without_drawn_taps(into.scene).taps.size();
        return compare::plans_of(r, catalogue, into.scene);
    } catch (const store::UsageError& e) {
        throw store::UsageError(where + e.what());
    } catch (const Refusal& e) {
        throw Refusal(where + e.what());
    }
}

bool makes_rows(const CellSet& set) {
    return std::ranges::any_of(facets(), [&set](const Facet& f) { return f.rows && set.measures(f.name); });
}

// Spectrogram and rows of a job's accuracy run, and what they are made of as JSON.
void add_facets(study::Job& job, const CellSet& set, int tap) {
    Json measured = Json::array();
    for (const Facet& f : facets())
        if (set.measures(f.name)) measured.push_back(f.name);
    if (set.measures(measured::spectrogram) || makes_rows(set)) measured.push_back({{"tap", job.point->scene.taps.at(tap).name}});
    if (!set.figures.identity.empty()) measured.push_back({{"figures", set.figures.identity}});
    job.measured = measured.dump();
    job.measure = [&set, tap](const study::Ran& ran, study::Record& into) {
        if (set.measures(measured::spectrogram)) into.levels = study::levels_of(ran.trace.column(tap), ran.trace.tap_rate);
        for (const Facet& f : facets())
            if (set.measures(f.name) && f.rows)
                into.rows[f.name] = f.rows({ran.point.scene, *ran.cell.scheme, ran.cell.settings, ran.trace, ran.reference, tap, set});
    };
}
}  // namespace

study::Plan plan_of(const Suite& suite, const compare::Catalogue& catalogue, const std::vector<std::string>& plugins) {
    study::Plan all;
    for (const SuitePoint& asked : points_of(suite)) {
        study::Point common;
        const std::vector<compare::Plan> plans = planned(asked, catalogue, common);
        const int tap = tap_of(*asked.set, common.scene);
        for (const std::string& assignment : asked.request.set) {
            const auto equals = assignment.find('=');
            common.swept.emplace_back(assignment.substr(0, equals), assignment.substr(equals + 1));
        }
        if (common.element) common.swept.emplace_back("element", study::change_of(*common.element));
        common.truth_modes = asked.request.reference_modes;
        common.time_limit = asked.set->time_limit.value_or(HUGE_VAL);
        for (const compare::Plan& plan : plans) {
            study::Point& p = all.points.emplace_back(common);
            p.references = plan.references;
            for (const std::string& note : plan.notes)
                if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end()) all.notes.push_back(note);
            for (const study::Cell& cell : plan.cells) {
                study::Job& job = all.jobs.emplace_back(study::Job{&p, cell});
                job.judged = asked.set->measures(measured::errors);
                job.repeats = asked.set->measures(measured::cost) ? asked.set->repeats : 0;
                job.set = static_cast<int>(asked.set - suite.sets.data());
                add_facets(job, *asked.set, tap);
            }
        }
    }
    study::address(all, store::program_identity(plugins));
    return all;
}

}  // namespace jvari::bench::suite
