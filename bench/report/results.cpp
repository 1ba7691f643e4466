#include "bench/report/results.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/store/cell_rows.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

store::Table read_table(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return {};
    try {
        return store::read_csv(store::as_utf8(store::read_whole(path)));
    } catch (const store::UsageError&) {
        throw;
    } catch (const std::runtime_error& e) {
        throw store::UsageError(fmt::format("{}: {}", path.string(), e.what()));
    }
}

namespace {
void must_have_rows(const store::Table& t, const fs::path& path) {
    if (!t.columns.empty() && t.rows.empty())
        throw store::UsageError(fmt::format("{}: it has no row below its header; make the results again", path.string()));
}

// cells.csv; of a committed record, which has none, errors.csv with the columns of cost.csv beside them: both hold the same runs in the
// same order.
store::Table read_cells(const fs::path& folder) {
    store::Table cells = read_table(folder / "cells.csv");
    must_have_rows(cells, folder / "cells.csv");
    if (!cells.columns.empty()) return cells;
    cells = read_table(folder / "errors.csv");
    must_have_rows(cells, folder / "errors.csv");
    const store::Table cost = read_table(folder / "cost.csv");
    if (cells.columns.empty() || cost.columns.empty()) return cells;
    const auto must_agree = [&](bool agree) {
        if (!agree)
            throw store::UsageError(fmt::format("{}: its rows are not those of errors.csv, run by run", (folder / "cost.csv").string()));
    };
    must_agree(cost.rows.size() == cells.rows.size());
    std::vector<std::string> clocked;
    for (const std::string& name : cost.columns) {
        if (cells.column(name) < 0) clocked.push_back(name);
        else
            for (std::size_t i = 0; i < cost.rows.size(); ++i) must_agree(cost.at(i, name) == cells.at(i, name));
    }
    cells.columns.insert(cells.columns.end(), clocked.begin(), clocked.end());
    for (std::size_t i = 0; i < cells.rows.size(); ++i)
        for (const std::string& name : clocked) cells.rows[i].push_back(cost.at(i, name));
    return cells;
}

std::string named_problem(const store::Table& t, std::size_t row, const std::vector<std::string>& keys, const std::string& scene) {
    std::string problem = t.column("scene") < 0 ? scene : t.at(row, "scene");
    for (const std::string& key : keys)
        if (key != "map" && !t.at(row, key).empty()) problem += fmt::format(", {} = {}", key, t.at(row, key));
    return problem;
}

void name_rows(store::Table& t, const std::string& scene) {
    const auto keys = store::swept_keys(t);
    std::vector<std::string> problems, names;
    std::map<std::string, std::set<std::string>> modes;  // of a scheme on a problem at a rate
    const auto place = [&](std::size_t i) { return problems[i] + "|" + names[i] + "|" + t.at(i, "rate"); };
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        problems.push_back(named_problem(t, i, keys, scene));
        names.push_back(store::variant_name(t.at(i, "scheme"), t.at(i, "options")));
        modes[place(i)].insert(t.at(i, "modes"));
    }
    std::set<std::string> several;  // schemes with more than one number of modes at a rate; without a rate, modes are its steps
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (t.column("rate") >= 0 && !t.at(i, "rate").empty() && modes[place(i)].size() > 1) several.insert(names[i]);
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const std::string series = names[i] + (several.contains(names[i]) ? fmt::format(", {} modes", t.at(i, "modes")) : "");
        t.rows[i].insert(t.rows[i].begin(), {problems[i], series});
    }
    t.columns.insert(t.columns.begin(), {"problem", "series"});
}

void read_manifest(Results& r) {
    const fs::path path = r.folder / "manifest.json";
    r.manifest = store::read_whole(path);
    try {
        store::refuse_deep(r.manifest);
        const Json m = Json::parse(r.manifest);
        r.about = m.value("date", "").substr(0, 10);  // the day
        r.command = m.value("command", "");
        r.controls = m.value("controls", false) ? compare::Controls::compete : compare::Controls::stand_beside;
        if (!m.contains("scene")) {  // of a suite
            r.name = m.value("suite", "");
            r.source = m.value("source", "");
            r.suite = r.name;
            return;
        }
        const Json &scene = m.at("scene"), &headline = m.at("headline");
        r.name = scene.at("name");
        r.source = scene.at("source");
        r.about = fmt::format("against {}, {} s; nut tap {}, bridge tap {}; {}", m.at("reference").at("name").get<std::string>(),
                              scene.at("duration").get<double>(), headline.at("nut").get<std::string>(),
                              headline.at("bridge").get<std::string>(), r.about);
        if (scene.contains("strings") && !scene.at("strings").empty())
            r.about = scene.at("strings").at(0).get<std::string>() + "; " + r.about;
    } catch (const std::exception& e) {  // Json::exception, what refuse_deep() throws
        throw store::UsageError(fmt::format("{}: {}", path.string(), e.what()));
    }
}
}  // namespace

Results read_results(const fs::path& folder) {
    Results r;
    r.folder = folder;
    std::error_code error;
    if (std::ranges::none_of(std::array{"cells.csv", "errors.csv", "maps.csv", "path.csv"},
                             [&](const char* n) { return fs::is_regular_file(folder / n, error); }))
        throw store::UsageError(fmt::format("cannot read {}, and there is no maps.csv", (folder / "cells.csv").string()));
    read_manifest(r);
    r.tables["cells"] = read_cells(folder);
    for (const char* name : {"dispersion", "convergence", "scaling", "maps", "boundaries", "sounds", "motion", "path", "needs", "claims"})
        r.tables[name] = read_table(folder / (std::string(name) + ".csv"));
    for (auto& [name, table] : r.tables)
        if (name != "path" && name != "needs" && name != "claims" && !table.columns.empty()) name_rows(table, r.name);
    r.cells = r.tables["cells"];
    r.sounds = r.tables["sounds"];
    return r;
}

}  // namespace jvari::bench::report
