#include "bench/compare/record/compare_record.hpp"
#include "bench/compare/scene_notes.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/compare/bound.hpp"
#include "bench/compare/record/pareto.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/study/columns.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::compare {

namespace {
using Json = nlohmann::ordered_json;

Json certificate_json(const Comparison& c) {
    const trust::Trust& t = c.against.trust;
    if (!t.any()) return {{"missing", t.missing}};
    Json figures = Json::object();
    for (std::size_t w = 0; w < trust::Trust::columns.size(); ++w) {
        figures[trust::Trust::columns[w]] = t.of_scene(c.headline.nut, w);
        for (std::size_t tap = 0; tap < c.scene().taps.size(); ++tap)
            figures[trust::Trust::columns[w] + ("_" + c.scene().taps[tap].name)] = t.of_scene(tap, w);
    }
    Json j{{"against", t.against}};
    if (!t.missing.empty()) j["missing"] = t.missing;  // the figures are what doubling tells
    if (!t.doubled.empty()) j["doubled"] = t.doubled;
    if (!t.file.empty()) j["file"] = std::filesystem::path(t.file).filename().string();
    if (!t.key.empty()) j["key"] = t.key, j["of_this_program"] = t.of_this_program;
    j["figures"] = figures;
    return j;
}
}  // namespace

store::Table cells_of(const Comparison& c) {
    return with_front(study::table_of(c.plan, c.outcome.records));
}

Json manifest_of(const Comparison& c, const CompareRequest& r) {
    const store::Table cells = cells_of(c);
    Json facts = Json::object(), floor = Json::object(), taps = Json::array(), schemes = Json::array();
    for (const Fact& f : c.reference_summary.facts) facts[f.name] = f.value;
    facts[facts::smallest_contact_force.name] = c.reference_summary.smallest_contact_force;
    facts[facts::largest_contact_force.name] = c.reference_summary.largest_contact_force;
    facts[facts::deepest_penetration.name] = c.reference_summary.deepest_penetration;
    for (std::size_t k = 0; k < study::measures().size(); ++k)
        floor[study::measures()[k].column] = c.against.floor[c.headline.tap(study::measures()[k])][k];
    for (std::size_t tap = 0; tap < c.scene().taps.size(); ++tap) {
        taps.push_back({{"name", c.scene().taps[tap].name}, {"quantity", name_of(c.scene().taps[tap].quantity)}});
        for (std::size_t k = 0; k < study::measures().size(); ++k)
            floor[study::measures()[k].column + "_" + c.scene().taps[tap].name] = c.against.floor[tap][k];
    }
    for (const study::Job& job : c.plan.jobs) {
        Json options = Json::object();
        for (const auto& [name, value] : job.cell.settings.options) options[name] = value;
        Json form{{"name", job.cell.scheme->name}, {"source", job.cell.scheme->source}, {"options", options}};
        if (std::find(schemes.begin(), schemes.end(), form) == schemes.end()) schemes.push_back(std::move(form));
    }
    Json reference{{"name", c.reference.name()},
                   {"source", c.reference.scheme->source},
                   {"rate", c.reference_summary.rate},
                   {"modes", c.reference_summary.modes},
                   {"status", name_of(c.reference_summary.status.outcome)},
                   {"valid_until_s", c.reference_summary.duration},
                   {"note", c.reference.note},
                   {"doubling", c.against.doubling},
                   {"horizon_of_half_s", c.horizon},
                   {"horizon_of_1e-12_s", study::horizon_of(c.against.floor, c.headline)},
                   {"certificate", certificate_json(c)},
                   {"facts", facts}};
    Json tap_rates = Json::array();
    for (const study::Point& p : c.plan.points) tap_rates.push_back(p.references.front().settings.tap_rate);
    Json tunings = Json::array();
    for (const String& string : c.scene().strings) tunings.push_back(tuning_text(string));
    const Json scene{{"name", c.scene().name},
                     {"asked_as", r.scene},
                     {"set", r.set},
                     {"source", c.scene().source},
                     {"hash", scene_hash(c.scene())},
                     {"duration", c.scene().duration},
                     {"strings", tunings},
                     {"taps", taps},
                     {"text", write_scene(c.scene())}};
    Json manifest = store::made_by();
    manifest.update({{"scene", scene},
                     {"tap_rate", c.reference.settings.tap_rate},
                     {"tap_rates", tap_rates},  // of each kind of rows: tap_rate is the first's
                     {"schemes", schemes},
                     {"reference", reference},
                     {"headline",
                      {{"nut", c.scene().taps.at(c.headline.nut).name},
                       {"bridge", c.scene().taps.at(c.headline.bridge).name},
                       {"error", headline_error(cells, store::all_rows(cells))}}},
                     {"noise_floor", floor},
                     {"controls", r.controls}});
    return manifest;
}

}  // namespace jvari::bench::compare
