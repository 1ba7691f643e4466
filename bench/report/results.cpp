#include "bench/report/results.hpp"

#include <fmt/core.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/store/cell_rows.hpp"
#include "bench/store/folder.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

namespace {
std::string named_problem(const store::Table& t, std::size_t row,
                          const std::vector<std::string>& keys, const std::string& scene) {
    std::string problem = t.column("scene") < 0 ? scene : t.at(row, "scene");
    for (const std::string& key : keys)
        if (key != "map" && !t.at(row, key).empty())
            problem += fmt::format(", {} = {}", key, t.at(row, key));
    return problem;
}

void name_rows(store::Table& t, const std::string& scene) {
    const auto keys = store::swept_keys(t);
    std::vector<std::string> problems, names;
    std::map<std::string, std::set<std::string>> modes;  // of a scheme on a problem at a rate
    const auto place = [&](std::size_t i) {
        return problems[i] + "|" + names[i] + "|" + t.at(i, "rate");
    };
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        problems.push_back(named_problem(t, i, keys, scene));
        names.push_back(store::variant_name(t.at(i, "scheme"), t.at(i, "options")));
        modes[place(i)].insert(t.at(i, "modes"));
    }
    // schemes with more than one number of modes at a rate; without a rate, modes are its steps
    std::set<std::string> several;
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (t.column("rate") >= 0 && !t.at(i, "rate").empty() && modes[place(i)].size() > 1)
            several.insert(names[i]);
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const std::string series =
            names[i] +
            (several.contains(names[i]) ? fmt::format(", {} modes", t.at(i, "modes")) : "");
        t.rows[i].insert(t.rows[i].begin(), {problems[i], series});
    }
    t.columns.insert(t.columns.begin(), {"problem", "series"});
}

void read_manifest(Results& r, const Json& m) {
    r.manifest = m.dump();
    r.about = m.value("date", "");
    r.command = m.value("command", "");
    r.controls =
        m.value("controls", false) ? compare::Controls::compete : compare::Controls::stand_beside;
    if (!m.contains("scene")) {  // of a suite
        r.name = m.value("suite", "");
        r.source = m.value("source", "");
        return;
    }
    const Json &scene = m.at("scene"), &headline = m.at("headline");
    r.name = scene.at("name");
    r.source = scene.at("source");
    r.about = fmt::format("against {}, {} s; nut tap {}, bridge tap {}; {}",
                          m.at("reference").at("name").get<std::string>(),
                          scene.at("duration").get<double>(), headline.at("nut").get<std::string>(),
                          headline.at("bridge").get<std::string>(), r.about);
    if (scene.contains("strings") && !scene.at("strings").empty())
        r.about = scene.at("strings").at(0).get<std::string>() + "; " + r.about;
}
}  // namespace

Results read_results(const fs::path& path) {
    const store::Folder folder{path};
    Results r;
    r.folder = path;
    r.tables["cells"] = folder.cells(true);
    for (const char* name :
         {"dispersion", "convergence", "maps", "boundaries", "sounds", "path", "needs"})
        r.tables[name] = folder.table(name);
    if (r.tables["cells"].columns.empty() && r.tables["maps"].columns.empty() &&
        r.tables["path"].columns.empty())
        throw store::UsageError(
            fmt::format("cannot read {}, and there is no maps.csv", (path / "cells.csv").string()));
    try {
        read_manifest(r, folder.manifest());
    } catch (const Json::exception& e) {
        throw store::UsageError(fmt::format("{}: {}", (path / "manifest.json").string(), e.what()));
    }
    for (auto& [name, table] : r.tables)
        if (name != "path" && name != "needs" && !table.columns.empty()) name_rows(table, r.name);
    r.cells = r.tables["cells"];
    r.sounds = r.tables["sounds"];
    return r;
}

}  // namespace jvari::bench::report
