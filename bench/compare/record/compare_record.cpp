#include "bench/compare/record/compare_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/compare/bound.hpp"
#include "bench/compare/record/pareto.hpp"
#include "bench/compare/summary.hpp"
#include "bench/store/indented.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/records.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::compare {

namespace {
using Json = nlohmann::ordered_json;
constexpr const char* cost_columns[] = {"cost_s_per_s",
                                        "cost_lower",
                                        "cost_upper",
                                        "processor_s_per_s",
                                        "processor_lower",
                                        "processor_upper",
                                        "wall_seconds",
                                        "wall_seconds_lower",
                                        "wall_seconds_upper",
                                        "ns_per_step",
                                        "times_real_time",
                                        "worst_block_of_deadline",
                                        "repeats",
                                        "machine",
                                        "load",
                                        "governor",
                                        "pareto"};

double error_in(const Cell& cell, int tap, int measure) {
    return cell.errors.empty() ? store::nan : cell.errors[tap][measure];
}

// error_l2_50ms: error_in_model_l2_50ms; third_octave_db: third_octave_db_in_model.
std::string in_model(const std::string& column) {
    const std::string error = "error_";
    return column.starts_with(error) ? error + "in_model_" + column.substr(error.size()) : column + "_in_model";
}

std::string status_of(const Cell& cell) {
    return cell.refused ? "refused" : !cell.needed ? "not_needed" : name_of(cell.summary.status.outcome);
}

// Facts of any cell, in the order in which they first come up.
std::vector<std::string> fact_names(const Comparison& c) {
    std::vector<std::string> names;
    for (const Cell& cell : c.cells)
        for (const Fact& f : cell.summary.facts)
            if (std::find(names.begin(), names.end(), f.name) == names.end()) names.push_back(f.name);
    return names;
}

// Headline errors that are no larger than what the reference's own sensitivity makes of 1e-12.
std::string ties_of(const Comparison& c, const Cell& cell) {
    std::string ties;
    for (std::size_t k = 0; k < measures().size(); ++k) {
        const Measure& m = measures()[k];
        const double error = error_in(cell, c.headline.tap(m), static_cast<int>(k)), floor = c.floor[c.headline.tap(m)][k];
        if (m.less_is_better && error <= floor) ties += (ties.empty() ? "" : " ") + m.column;
    }
    return ties;
}

class Row {  // one row, and on the first one the columns
public:
    Row(store::Table& table, bool first) : table_(table), first_(first) { table_.rows.emplace_back(); }
    void text(const std::string& column, const std::string& value) {
        if (first_) table_.columns.push_back(column);
        table_.rows.back().push_back(value);
    }
    void number(const std::string& column, double value) { text(column, store::text_of(value)); }
    void count(const std::string& column, long value, bool known) { text(column, known ? std::to_string(value) : ""); }

private:
    store::Table& table_;
    bool first_;
};

void add_row(store::Table& table, const Comparison& c, const Cell& cell, const std::vector<std::string>& facts) {
    Row row(table, table.rows.empty());
    const Summary& s = cell.summary;
    const bool ran = !cell.refused, failed = ran && s.status.outcome != Outcome::ok;
    row.text("scheme", cell.scheme->name);
    row.text("options", store::options_text(cell.settings.options));
    row.number("rate", cell.scheme->clock == Clock::continuous ? store::nan : cell.settings.sample_rate);
    row.count("modes", cell.modes(), cell.modes() > 0);
    row.text("status", status_of(cell));
    row.text("flags", ran ? names_of(flags_of(s)) : "");
    for (std::size_t k = 0; k < measures().size(); ++k)
        row.number(measures()[k].column, error_in(cell, c.headline.tap(measures()[k]), static_cast<int>(k)));
    const double seconds = ran && s.duration > 0 ? s.duration : store::nan, wall = ran ? cell.wall.median : store::nan;
    row.number("cost_s_per_s", wall / seconds);
    row.number("cost_lower", ran ? cell.wall.lower / seconds : store::nan);
    row.number("cost_upper", ran ? cell.wall.upper / seconds : store::nan);
    row.number("processor_s_per_s", ran ? cell.processor.median / seconds : store::nan);
    row.number("processor_lower", ran ? cell.processor.lower / seconds : store::nan);
    row.number("processor_upper", ran ? cell.processor.upper / seconds : store::nan);
    row.number("wall_seconds", wall);
    row.number("wall_seconds_lower", ran ? cell.wall.lower : store::nan);
    row.number("wall_seconds_upper", ran ? cell.wall.upper : store::nan);
    row.number("ns_per_step", s.steps > 0 ? wall * 1e9 / s.steps : store::nan);
    row.number("times_real_time", seconds / wall);
    row.number("worst_block_of_deadline", ran ? cell.worst_block : store::nan);
    row.count("repeats", cell.wall.count, ran);
    row.text("machine", ran ? cell.stamp.name : "");
    row.text("load", ran ? cell.stamp.load : "");
    row.text("governor", ran ? cell.stamp.governor : "");
    row.text("pareto", "");  // once all rows are there
    row.text("below_floor", ties_of(c, cell));
    for (std::size_t k = 0; k < measures().size(); ++k)
        if (measures()[k].less_is_better) row.number("floor_" + measures()[k].column, c.floor[c.headline.tap(measures()[k])][k]);
    row.number("energy_residual_per_step", ran ? s.energy_residual_per_step : store::nan);
    row.number("energy_residual_accumulated", ran ? s.energy_residual_accumulated : store::nan);
    row.number(facts::smallest_contact_force.name, ran ? s.smallest_contact_force : store::nan);
    row.number(facts::deepest_penetration.name, ran ? s.deepest_penetration : store::nan);
    row.count("dofs", s.dofs, ran);
    row.count("state_bytes", 8L * s.dofs, ran);
    row.count("steps", s.steps, ran);
    row.count("failed_step", s.status.step, failed);
    row.number("failed_at_s", failed ? s.duration : store::nan);
    for (const std::string& name : facts) row.number("fact_" + name, fact(s.facts, name));
    for (std::size_t tap = 0; tap < c.scene.taps.size(); ++tap)
        for (std::size_t k = 0; k < measures().size(); ++k)
            row.number(measures()[k].column + "_" + c.scene.taps[tap].name, error_in(cell, static_cast<int>(tap), static_cast<int>(k)));
    for (std::size_t tap = 0; tap < c.scene.taps.size(); ++tap)
        for (std::size_t k = 0; k < measures().size(); ++k)
            if (measures()[k].less_is_better) row.number("floor_" + measures()[k].column + "_" + c.scene.taps[tap].name, c.floor[tap][k]);
    row.text("reason", cell.reason);
    const auto all_taps = [&c](const auto& each) {
        for (std::size_t tap = 0; tap < c.scene.taps.size(); ++tap) each(static_cast<int>(tap), "_" + c.scene.taps[tap].name);
    };
    const auto figures = [&](int tap, const std::string& suffix) {
        for (std::size_t w = 0; w < trust::Trust::columns.size(); ++w)
            row.number(trust::Trust::columns[w] + suffix, c.trust.of_scene(tap, w));
    };
    figures(c.headline.nut, "");
    all_taps(figures);
    row.count("reference_modes", c.reference_settings.modes, c.reference_settings.modes > 0);
    row.number("reference_horizon_s", horizon_of(c.floor, c.headline));
    row.text("reference_doubling", c.truth);
    const auto own = [&](std::size_t tap, std::size_t k) { return cell.in_model.empty() ? store::nan : cell.in_model[tap][k]; };
    for (std::size_t k = 0; k < measures().size(); ++k) row.number(in_model(measures()[k].column), own(c.headline.tap(measures()[k]), k));
    all_taps([&](int tap, const std::string& suffix) {
        for (std::size_t k = 0; k < measures().size(); ++k) row.number(in_model(measures()[k].column) + suffix, own(tap, k));
    });
    const auto solved = [&](int tap, const std::string& suffix) {
        for (std::size_t w = 0; w < trust::Trust::columns.size(); ++w)
            row.number("certificate_in_model" + std::string(trust::Trust::columns[w]).substr(std::string("certificate").size()) + suffix,
                       c.model_trust.in_model(tap, w));
    };
    solved(c.headline.nut, "");
    all_taps(solved);
}

Json certificate_json(const Comparison& c) {
    const trust::Trust& t = c.trust;
    if (!t.any()) return {{"missing", t.missing}};
    Json figures = Json::object();
    for (std::size_t w = 0; w < trust::Trust::columns.size(); ++w) {
        figures[trust::Trust::columns[w]] = t.of_scene(c.headline.nut, w);
        for (std::size_t tap = 0; tap < c.scene.taps.size(); ++tap)
            figures[trust::Trust::columns[w] + ("_" + c.scene.taps[tap].name)] = t.of_scene(tap, w);
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
    store::Table table;
    const auto facts = fact_names(c);
    for (const Cell& cell : c.cells) add_row(table, c, cell, facts);
    const store::Rows rows = store::all_rows(table);
    const auto front = pareto_front(table, rows, headline_error(table, rows), "cost_s_per_s");
    for (const std::size_t i : rows) table.rows[i][table.column("pareto")] = front[i] ? "1" : "0";
    return table;
}

store::Table errors_only(const store::Table& cells) {
    std::vector<std::string> names;
    for (const std::string& name : cells.columns)
        if (std::find(std::begin(cost_columns), std::end(cost_columns), name) == std::end(cost_columns)) names.push_back(name);
    return cells.only(names);
}

store::Table cost_only(const store::Table& cells) {
    std::vector<std::string> names{"scheme", "options", "rate", "modes", "status"};
    names.insert(names.end(), std::begin(cost_columns), std::end(cost_columns));
    return cells.only(names);
}

std::string manifest_of(const Comparison& c, const CompareRequest& r) {
    const store::Table cells = cells_of(c);
    Json facts = Json::object(), floor = Json::object(), taps = Json::array(), schemes = Json::array();
    for (const Fact& f : c.reference_summary.facts) facts[f.name] = f.value;
    facts[facts::smallest_contact_force.name] = c.reference_summary.smallest_contact_force;
    facts[facts::largest_contact_force.name] = c.reference_summary.largest_contact_force;
    facts[facts::deepest_penetration.name] = c.reference_summary.deepest_penetration;
    for (std::size_t k = 0; k < measures().size(); ++k) floor[measures()[k].column] = c.floor[c.headline.tap(measures()[k])][k];
    for (std::size_t tap = 0; tap < c.scene.taps.size(); ++tap) {
        taps.push_back({{"name", c.scene.taps[tap].name}, {"quantity", name_of(c.scene.taps[tap].quantity)}});
        for (std::size_t k = 0; k < measures().size(); ++k) floor[measures()[k].column + "_" + c.scene.taps[tap].name] = c.floor[tap][k];
    }
    for (const Cell& cell : c.cells) {
        Json options = Json::object();
        for (const auto& [name, value] : cell.settings.options) options[name] = value;
        Json form{{"name", cell.scheme->name}, {"source", cell.scheme->source}, {"options", options}};
        if (std::find(schemes.begin(), schemes.end(), form) == schemes.end()) schemes.push_back(std::move(form));
    }
    Json reference{{"name", c.reference_name},
                   {"source", c.reference->source},
                   {"rate", c.reference_summary.rate},
                   {"modes", c.reference_summary.modes},
                   {"status", name_of(c.reference_summary.status.outcome)},
                   {"valid_until_s", c.reference_summary.duration},
                   {"note", c.reference_note},
                   {"doubling", c.truth},
                   {"horizon_of_half_s", c.horizon},
                   {"horizon_of_1e-12_s", horizon_of(c.floor, c.headline)},
                   {"certificate", certificate_json(c)},
                   {"facts", facts}};
    const Json scene{{"name", c.scene.name},        {"asked_as", r.scene},          {"set", r.set}, {"source", c.scene.source},
                     {"hash", scene_hash(c.scene)}, {"duration", c.scene.duration}, {"taps", taps}, {"text", write_scene(c.scene)}};
    Json manifest = Json::parse(store::made_by());
    manifest.update({{"scene", scene},
                     {"tap_rate", c.reference_settings.tap_rate},
                     {"schemes", schemes},
                     {"reference", reference},
                     {"headline",
                      {{"nut", c.scene.taps.at(c.headline.nut).name},
                       {"bridge", c.scene.taps.at(c.headline.bridge).name},
                       {"error", headline_error(cells, store::all_rows(cells))}}},
                     {"noise_floor", floor},
                     {"controls", r.controls}});
    return store::indented(manifest);
}

}  // namespace jvari::bench::compare
