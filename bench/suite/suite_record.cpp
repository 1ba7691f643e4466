#include "bench/suite/suite_record.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/compare/record/compare_record.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/whole.hpp"

namespace jvari::bench::suite {

namespace {
using Json = nlohmann::ordered_json;

store::Table row_of(const PlannedCell& planned, const compare::Cell& cell,
                    const Against& against) {  // compare's row of a comparison of this cell alone
    compare::Comparison c;
    c.scene = without_drawn_taps(planned.point->scene);
    c.headline = compare::headline_of(c.scene);
    c.floor = against.floor;
    c.trust = against.trust;
    c.model_trust = against.model_trust;
    c.reference_settings.modes = against.modes;
    c.truth = against.truth;
    if (against.floor.empty())
        c.floor.assign(c.scene.taps.size(), std::vector<double>(compare::measures().size(), std::numeric_limits<double>::quiet_NaN()));
    c.cells = {cell};
    return compare::cells_of(c);
}

void set(store::Table& row, const std::string& column, const std::string& value) {
    if (const int k = row.column(column); k >= 0) row.rows[0][k] = value;
}
}  // namespace

SuiteRecord record_of(const PlannedCell& planned, const compare::Cell& cell, const Against& against) {
    SuiteRecord r;
    compare::Cell untimed = cell;
    untimed.wall = untimed.processor = spread_of({});
    r.row = row_of(planned, untimed, against);
    r.ran = !cell.refused;
    r.duration = cell.summary.duration;
    r.seconds = cell.summary.wall_seconds;
    r.steps = cell.summary.steps;
    r.stamp = store::stamp_now();
    if (cell.refused) r.duration = r.seconds = 0, r.steps = 0;
    return r;
}

void add_clock(SuiteRecord& r, const PlannedCell& planned, const KeptClock& clock) {
    compare::Cell cell = planned.cell;
    cell.wall = clock.wall;
    cell.processor = clock.processor;
    cell.worst_block = clock.worst_block;
    cell.stamp = clock.stamp;
    cell.summary.duration = r.duration;
    cell.summary.steps = r.steps;
    const store::Table row = row_of(planned, cell, {}), rest = compare::errors_only(row);
    for (std::size_t k = 0; k < row.columns.size(); ++k)
        if (rest.column(row.columns[k]) < 0) set(r.row, row.columns[k], row.rows[0][k]);
    r.timed = true;
}

std::string json_of(const SuiteRecord& r, const std::string& identity) {
    Json row = Json::array();
    for (std::size_t k = 0; k < r.row.columns.size(); ++k) row.push_back(Json::array({r.row.columns[k], r.row.rows[0][k]}));
    Json j{{"cell", Json::parse(identity)},
           {"row", row},
           {"reference", r.reference},
           {"ran", r.ran},
           {"duration", r.duration},
           {"seconds", r.seconds},
           {"steps", r.steps},
           {"stamp", Json::parse(store::json_of(r.stamp))}};
    const Levels& l = r.levels;
    j["levels"] = {{"frames", l.frames}, {"rows", l.rows},     {"start", l.start},
                   {"hop", l.hop},       {"row_hz", l.row_hz}, {"tenths_of_db", l.level}};
    for (const auto& [facet, table] : r.rows) j["rows"][facet] = {{"columns", table.columns}, {"rows", table.rows}};
    return store::sealed(j.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::optional<SuiteRecord> read_record(const std::filesystem::path& path, const std::string& identity) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
    try {
        const Json j = Json::parse(store::unsealed(store::read_whole(path)));
        if (j.at("cell") != Json::parse(identity)) return std::nullopt;
        SuiteRecord r;
        r.row.rows.emplace_back();
        for (const Json& field : j.at("row")) {
            r.row.columns.push_back(field.at(0));
            r.row.rows[0].push_back(field.at(1));
        }
        r.reference = j.at("reference");
        r.ran = j.at("ran");
        r.duration = j.at("duration");
        r.seconds = j.at("seconds");
        r.steps = store::whole<long>(j.at("steps"));
        if (const auto stamp = j.find("stamp"); stamp != j.end()) r.stamp = store::stamp_of(stamp->dump());
        const Json& l = j.at("levels");
        r.levels = {store::whole<int>(l.at("frames")), store::whole<int>(l.at("rows")), l.at("start"), l.at("hop"), l.at("row_hz"), {}};
        for (const Json& tenths : l.at("tenths_of_db")) r.levels.level.push_back(store::whole<int>(tenths));
        if (j.contains("rows"))
            for (const auto& [facet, kept] : j["rows"].items()) r.rows[facet] = {kept.at("columns"), kept.at("rows")};
        if (r.levels.frames < 0 || r.levels.rows < 0) return std::nullopt;
        if (r.levels.level.size() != static_cast<std::size_t>(r.levels.frames) * r.levels.rows) return std::nullopt;
        for (const auto& [facet, table] : r.rows)
            for (const auto& fields : table.rows)
                if (fields.size() != table.columns.size()) return std::nullopt;
        return r;
    } catch (const std::exception&) {  // Json::exception, UsageError, what unsealed() throws
        return std::nullopt;
    }
}

store::Table table_of(const SuitePlan& plan, const std::vector<SuiteRecord>& records) {
    store::Table t;
    t.columns = {"cell", "scene"};
    const auto add = [&t](const std::string& name) {
        if (t.column(name) < 0) t.columns.push_back(name);
    };
    for (const PlannedCell& c : plan.cells)
        for (const auto& [key, value] : c.point->swept) add(key);
    for (const char* name : {"scheme", "options"}) add(name);
    for (const SuiteRecord& r : records)
        for (const std::string& name : r.row.columns)
            if (name != "pareto" && name != "reason" && name.rfind("certificate_", 0) != 0)
                add(name);  // the front is of one scene, and a table holds many
    for (const char* name : {"reference", "reason"}) add(name);
    for (const SuiteRecord& r : records)
        for (const std::string& name : r.row.columns)
            if (name != "pareto") add(name);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const PlannedCell& c = plan.cells[i];
        auto& row = t.rows.emplace_back();
        for (const std::string& name : t.columns) {
            const auto swept = std::find_if(c.point->swept.begin(), c.point->swept.end(), [&](const auto& s) { return s.first == name; });
            row.push_back(name == "cell"                  ? c.id
                          : name == "scene"               ? c.point->scene.name
                          : name == "options"             ? store::options_text(c.cell.settings.options)
                          : name == "reference"           ? records[i].reference
                          : swept != c.point->swept.end() ? swept->second
                                                          : records[i].row.at(0, name));
        }
    }
    return t;
}

store::Table rows_of(const std::string& facet, const SuitePlan& plan, const std::vector<SuiteRecord>& records) {
    const store::Table cells = table_of(plan, records);
    std::vector<std::string> names(cells.columns.begin(), cells.columns.begin() + cells.column("options") + 1);
    names.insert(names.end(), {"rate", "modes"});
    store::Table t = cells.only(names);
    t.rows.clear();
    for (const SuiteRecord& r : records)
        if (const auto own = r.rows.find(facet); own != r.rows.end() && !own->second.columns.empty()) {
            t.columns.insert(t.columns.end(), own->second.columns.begin(), own->second.columns.end());
            break;
        }
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto own = records[i].rows.find(facet);
        if (own == records[i].rows.end()) continue;
        std::vector<std::string> who;
        for (const std::string& name : names) who.push_back(cells.at(i, name));
        for (const auto& fields : own->second.rows) {
            t.rows.push_back(who);
            t.rows.back().insert(t.rows.back().end(), fields.begin(), fields.end());
        }
    }
    return t;
}

}  // namespace jvari::bench::suite
