#include "bench/compare/kept_cells.hpp"

#include <cstring>
#include <nlohmann/json.hpp>

#include "bench/store/base64.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/outcome_name.hpp"
#include "bench/store/records.hpp"
#include "bench/store/whole.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::compare {

namespace {
using Json = nlohmann::ordered_json;

Json settings_json(const Settings& s) {
    return {store::text_of(s.sample_rate), store::text_of(s.tap_rate), s.modes, s.options};
}

Json numbers(const Errors& errors) {  // as texts: JSON has no NaN
    Json all = Json::array();
    for (const auto& tap : errors) {
        Json row = Json::array();
        for (const double x : tap) row.push_back(store::text_of(x));
        all.push_back(row);
    }
    return all;
}
Errors errors_in(const Json& j) {
    Errors errors;
    for (const Json& row : j) {
        errors.emplace_back();
        for (const Json& x : row) errors.back().push_back(store::number_of(x));
    }
    return errors;
}

// Every number of a summary, in one order for both ways.
template <class Summary_, class Number>
void each_number(Summary_& s, Number number) {
    number("rate", s.rate);
    number("duration", s.duration);
    number("wall_seconds", s.wall_seconds);
    number("ns_per_step", s.ns_per_step);
    number("times_real_time", s.times_real_time);
    number("energy_residual_per_step", s.energy_residual_per_step);
    number("energy_residual_accumulated", s.energy_residual_accumulated);
    number("smallest_contact_force", s.smallest_contact_force);
    number("largest_contact_force", s.largest_contact_force);
    number("deepest_penetration", s.deepest_penetration);
}
}  // namespace

std::string identity_of(const Cell& cell, const Reference& truth, const Reference& model, const Scene& scene) {
    std::vector<std::string> plugins;
    for (const LoadedPlugin& l : loaded_plugins()) plugins.push_back(l.path);
    const auto reference = [](const Reference& r) -> Json { return {r.choice.name(), settings_json(r.choice.settings)}; };
    return Json{{"program", Json::parse(store::program_identity(plugins))},
                {"scene", scene.name},
                {"scene_hash", scene_hash(scene)},
                {"scheme", cell.scheme->name},
                {"settings", settings_json(cell.settings)},
                {"truth", reference(truth)},
                {"model", reference(model)}}
        .dump();
}

std::string json_of(const Cell& cell, const std::string& identity) {
    const Summary& s = cell.summary;
    Json summary{{"scheme", s.scheme}, {"scene", s.scene}, {"modes", s.modes}, {"dofs", s.dofs}, {"steps", s.steps}, {"rows", s.rows}};
    summary["status"] = {name_of(s.status.outcome), s.status.step};
    each_number(s, [&summary](const char* name, double x) { summary[name] = store::text_of(x); });
    summary["facts"] = Json::array();
    for (const Fact& f : s.facts) summary["facts"].push_back({f.name, store::text_of(f.value), f.unit});
    const std::string_view samples(reinterpret_cast<const char*>(cell.sound.samples.data()),
                                   cell.sound.samples.size() * sizeof(std::int16_t));
    return store::sealed(Json{{"cell_of_comparison", Json::parse(identity)},
                              {"reason", cell.reason},
                              {"summary", summary},
                              {"errors", numbers(cell.errors)},
                              {"in_model", numbers(cell.in_model)},
                              {"sound", {store::text_of(cell.sound.rate), store::text_of(cell.sound.peak), store::base64(samples)}}}
                             .dump(-1, ' ', false, Json::error_handler_t::replace));
}

bool read_cell(const std::filesystem::path& path, const std::string& identity, Cell& into) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;
    try {
        const Json j = Json::parse(store::unsealed(store::read_whole(path)));
        if (j.at("cell_of_comparison") != Json::parse(identity)) return false;
        Cell cell = into;
        cell.reason = j.at("reason");
        const Json& summary = j.at("summary");
        Summary& s = cell.summary;
        s.scheme = summary.at("scheme");
        s.scene = summary.at("scene");
        s.modes = store::whole<int>(summary.at("modes"));
        s.dofs = store::whole<int>(summary.at("dofs"));
        s.steps = store::whole<long>(summary.at("steps"));
        s.rows = store::whole<long>(summary.at("rows"));
        s.status = {store::outcome_named(summary.at("status").at(0)), store::whole<long>(summary.at("status").at(1))};
        each_number(s, [&summary](const char* name, double& x) { x = store::number_of(summary.at(name)); });
        for (const Json& f : summary.at("facts")) s.facts.push_back({f.at(0), store::number_of(f.at(1)), f.at(2)});
        cell.errors = errors_in(j.at("errors"));
        cell.in_model = errors_in(j.at("in_model"));
        cell.sound.rate = store::number_of(j.at("sound").at(0));
        cell.sound.peak = store::number_of(j.at("sound").at(1));
        const std::string samples = store::bytes_of_base64(j.at("sound").at(2).get<std::string>());
        cell.sound.samples.resize(samples.size() / sizeof(std::int16_t));
        std::memcpy(cell.sound.samples.data(), samples.data(), cell.sound.samples.size() * sizeof(std::int16_t));
        into = std::move(cell);
        return true;
    } catch (const std::exception&) {  // Json::exception, UsageError, what unsealed() throws
        return false;
    }
}

}  // namespace jvari::bench::compare
