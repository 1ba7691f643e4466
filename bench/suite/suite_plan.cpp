#include "bench/suite/suite_plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/records.hpp"
#include "bench/suite/facet.hpp"
#include "bench/trust/certificate_library.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::suite {

namespace {
using Json = nlohmann::ordered_json;

Json settings_json(const Settings& s) {
    Json options = Json::array();
    for (const auto& [name, value] : s.options) options.push_back({name, value});
    return {{"rate", store::text_of(s.sample_rate)}, {"tap_rate", store::text_of(s.tap_rate)}, {"modes", s.modes}, {"options", options}};
}

int tap_of(const CellSet& set, const Scene& scene) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < scene.taps.size(); ++k) {
        if (set.tap.empty() || scene.taps[k].name == set.tap) return static_cast<int>(k);
        names.push_back(scene.taps[k].name);
    }
    throw store::UsageError(store::unknown("tap", set.tap, names));
}

// What one scene of the file is; messages of compare's planner come with its name.
compare::Plan planned(const SuitePoint& point, const compare::Catalogue& catalogue, PlannedPoint& into) {
    const compare::CompareRequest& r = point.request;
    const std::string where = "scene " + r.scene + ": ";
    into.scene = compare::load_scene(r.scene, r.set, r.duration);
    into.element = point.element;
    try {
        if (point.element) into.scene = compare::without(*point.element, std::move(into.scene));
        into.scene = with_figure_taps(into.scene, point.set->figures);
        compare::Plan plan = compare::plan_of(r, catalogue, into.scene);
        into.tap = tap_of(*point.set, into.scene);
        return plan;
    } catch (const store::UsageError& e) {
        throw store::UsageError(where + e.what());
    } catch (const Refusal& e) {
        throw Refusal(where + e.what());
    }
}

bool makes_rows(const CellSet& set) {
    return std::ranges::any_of(facets(), [&set](const Facet& f) { return f.rows && set.measures(f.name); });
}
}  // namespace

SuitePlan plan_of(const Suite& suite, const compare::Catalogue& catalogue, const std::vector<std::string>& plugins) {
    const Json program = Json::parse(store::program_identity(plugins));
    SuitePlan all;
    std::set<std::string> seen;
    for (const SuitePoint& point : points_of(suite)) {
        PlannedPoint& p = all.points.emplace_back();
        const compare::Plan plan = planned(point, catalogue, p);
        for (const std::string& assignment : point.request.set) {
            const auto equals = assignment.find('=');
            p.swept.emplace_back(assignment.substr(0, equals), assignment.substr(equals + 1));
        }
        if (p.element) p.swept.emplace_back("element", compare::change_of(*p.element));
        p.references = plan.references;
        for (const std::string& note : plan.notes)
            if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end()) all.notes.push_back(note);
        const std::string hash = scene_hash(p.scene);
        Json references = Json::array(), measure = Json::array();
        for (const compare::ReferenceChoice& c : plan.references)
            references.push_back({{"name", c.scheme->name}, {"settings", settings_json(c.settings)}});
        const std::string limit = store::text_of(point.set->time_limit.value_or(HUGE_VAL));
        p.reference_key = hash + references.dump() + limit;
        if (point.request.reference_modes) {
            p.truth_modes = *point.request.reference_modes;
            Json modeless = references;
            for (Json& r : modeless) r["settings"].erase("modes");
            p.truth_key = std::to_string(p.truth_modes) + hash + modeless.dump() + limit;
        }
        for (const Facet& f : facets())
            if (point.set->measures(f.name)) measure.push_back(f.name);
        for (const compare::Cell& cell : plan.cells) {
            Json identity{{"program", program},
                          {"scene", p.scene.name},
                          {"scene_hash", hash},
                          {"scheme", cell.scheme->name},
                          {"settings", settings_json(cell.settings)},
                          {"measure", measure}};
            if (point.set->measures(measured::errors)) {
                identity["references"] = references;
                if (point.request.reference_modes) identity["reference_modes"] = *point.request.reference_modes;
            }
            if (point.set->measures(measured::cost)) identity["repeats"] = point.set->repeats;
            if (point.set->measures(measured::spectrogram) || makes_rows(*point.set)) identity["tap"] = p.scene.taps.at(p.tap).name;
            if (!point.set->figures.identity.empty()) identity["figures"] = point.set->figures.identity;
            if (p.element && compare::is_added(*p.element)) identity[compare::name_of(*p.element)] = true;
            if (point.set->time_limit) identity["time_limit_s"] = *point.set->time_limit;
            PlannedCell planned_cell{point.set, &p, cell, identity.dump(), {}};
            if (!seen.insert(planned_cell.identity).second) continue;
            planned_cell.id = store::hash_of(planned_cell.identity);
            all.cells.push_back(std::move(planned_cell));
        }
    }
    return all;
}

std::string what_of(const PlannedCell& c) {
    std::string text = c.point->scene.name;
    for (const auto& [key, value] : c.point->swept) text += " " + key + "=" + value;
    text += ": " + store::variant_name(c.cell.scheme->name, store::options_text(c.cell.settings.options));
    if (c.cell.settings.sample_rate > 0) text += fmt::format(" at {} Hz", c.cell.settings.sample_rate);
    return text;
}

std::vector<store::Rows> sets_of(const SuitePlan& plan) {
    std::map<const CellSet*, store::Rows> sets;  // in the order of the file: they lie in one vector
    for (std::size_t i = 0; i < plan.cells.size(); ++i) sets[plan.cells[i].set].push_back(i);
    std::vector<store::Rows> all;
    for (auto& [set, cells] : sets) all.push_back(std::move(cells));
    return all;
}

}  // namespace jvari::bench::suite
