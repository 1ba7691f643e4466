#include "bench/report/results.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "bench/compare/bound.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/report/report.hpp"
#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

namespace {
struct Named {  // distinguishes the series of rows
    std::string problem, variant;
    store::Field rate, modes;
};
std::vector<std::string> series_of(const std::vector<Named>& rows) {
    const auto place = [](const Named& n) {
        return n.problem + "|" + n.variant + "|" + n.rate.text();
    };
    std::map<std::string, std::set<std::string>> modes;  // for a scheme on a problem at a rate
    for (const Named& n : rows) modes[place(n)].insert(n.modes.text());
    // Schemes with more than one number of modes at the same rate. Rows without a rate keep a
    // single series, stepped by modes.
    std::set<std::string> several;
    for (const Named& n : rows)
        if (!n.rate.empty() && modes[place(n)].size() > 1) several.insert(n.variant);
    std::vector<std::string> series;
    for (const Named& n : rows)
        series.push_back(n.variant +
                         (several.contains(n.variant) ? ", " + n.modes.text() + " modes" : ""));
    return series;
}

void name_rows(store::Table& t, const std::string& scene) {
    if (t.column("problem") >= 0) return;  // a table of results.json
    const auto from = std::ranges::find(t.columns, "scene"),
               to = std::ranges::find(t.columns, "scheme");
    const bool swept = from != t.columns.end() && to - from > 1;
    const std::vector<std::string> keys(swept ? from + 1 : to, to);
    std::vector<Named> rows;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        std::string problem = from == t.columns.end() ? scene : t.text(i, "scene");
        for (const std::string& key : keys)
            if (key != "map" && !t.at(i, key).empty())
                problem += fmt::format(", {} = {}", key, t.text(i, key));
        rows.push_back({problem, store::variant_name(t.text(i, "scheme"), t.text(i, "options")),
                        t.at(i, "rate"), t.at(i, "modes")});
    }
    const auto series = series_of(rows);
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        t.rows[i].insert(t.rows[i].begin(), {rows[i].problem, series[i]});
    t.columns.insert(t.columns.begin(), {"problem", "series"});
}

void read_manifest(Results& r, const Json& m) {
    r.manifest = store::compact(m);
    r.date = m.value("date", "");
    r.command = m.value("command", "");
    r.controls =
        m.value("controls", false) ? compare::Controls::compete : compare::Controls::stand_beside;
    if (!m.contains("scene")) {  // manifest of a suite
        r.name = m.value("suite", "");
        r.source = m.value("source", "");
        return;
    }
    const Json& scene = m.at("scene");
    r.name = scene.at("name");
    r.source = scene.at("source");
    r.about = fmt::format("against {}, {} s", m.at("reference").at("name").get<std::string>(),
                          scene.at("duration").get<double>());
    if (scene.contains("strings") && !scene.at("strings").empty())
        r.about = scene.at("strings").at(0).get<std::string>() + "; " + r.about;
}
}  // namespace

std::string trimmed_scene(const Json& manifest) {
    if (const auto scene = manifest.find("trimmed"); scene != manifest.end()) return *scene;
    // manifests of older programs
    const auto request = manifest.find("asked");
    return request == manifest.end() ? "" : request->value("scene", "");
}

Results read_results(const fs::path& path) {
    const store::Folder folder{path};
    Results r;
    r.folder = path;
    for (const char* name : {"strings", "fronts", "advice"}) r.tables[name] = folder.table(name);
    // a population has too many cells
    const bool population = !r.tables["strings"].columns.empty();
    if (!population) r.cells = study::read_cells(folder, true);
    for (const char* name : {"convergence", "maps", "boundaries", "sounds", "path", "needs"})
        r.tables[name] = folder.table(name);
    if (r.cells.empty() && !population && r.tables["maps"].columns.empty() &&
        r.tables["path"].columns.empty())
        throw store::UsageError(
            fmt::format("cannot read {}, and there is no maps.csv", (path / "facts.csv").string()));
    try {
        read_manifest(r, folder.manifest());
    } catch (const Json::exception& e) {
        throw store::UsageError(fmt::format("{}: {}", (path / "manifest.json").string(), e.what()));
    }
    for (auto& [name, table] : r.tables)
        if (!population && name != "path" && name != "needs" && !table.columns.empty())
            name_rows(table, r.name);
    std::vector<Named> named;
    for (const study::TabledCell& c : r.cells)
        named.push_back({c.problem(), c.variant(), c.rate, c.modes});
    r.series = series_of(named);
    // results.json may have come without the sounds
    if (!folder.is_one_file() || fs::is_directory(path / "sounds")) r.sounds = r.tables["sounds"];
    return r;
}

namespace {
// Priority of a sound for the reader: 0 a reference, 1 the cheapest within an accuracy, 2 a scheme
// at its highest rate, 3 at its lowest, 4 otherwise.
int place_of(const store::Table& t, std::size_t i, const store::Table& cheapest) {
    if (t.at(i, "scheme") == "reference") return 0;
    for (std::size_t k = 0; k < cheapest.rows.size(); ++k)
        if (std::ranges::all_of(
                std::initializer_list<const char*>{"problem", "scheme", "options", "rate"},
                [&](const char* name) { return cheapest.at(k, name) == t.at(i, name); }))
            return 1;
    double lowest = HUGE_VAL, highest = 0;
    for (std::size_t k = 0; k < t.rows.size(); ++k)
        if (t.at(k, "problem") == t.at(i, "problem") && t.at(k, "series") == t.at(i, "series")) {
            lowest = std::fmin(lowest, t.number(k, "rate"));
            highest = std::fmax(highest, t.number(k, "rate"));
        }
    const double rate = t.number(i, "rate");
    return !(rate < highest) ? 2 : rate <= lowest ? 3 : 4;
}
}  // namespace

Json json_of(const study::Levels& l) {
    return {{"start", l.start},
            {"hop", l.hop},
            {"row_hz", l.row_hz},
            {"frames", l.frames},
            {"rows", l.rows},
            {"level", store::base64(std::vector<std::int16_t>(l.level.begin(), l.level.end()))}};
}

Json json_of(const store::Sound& s, double longest) {
    return {{"rate", s.rate},
            {"peak", s.peak},
            {"samples", store::base64(std::span(s.samples).first(std::min(
                            s.samples.size(), static_cast<std::size_t>(longest * s.rate))))}};
}

fs::path sound_file(const Results& r, std::size_t row) {
    const fs::path file = r.sounds.text(row, "file");
    if (file.is_absolute() || std::find(file.begin(), file.end(), "..") != file.end())
        throw store::UsageError(fmt::format("{}: found the file {}, expected one below the folder",
                                            (r.folder / "sounds.csv").string(), file.string()));
    return r.folder / file;
}

Json heard(const Results& r, const store::Table& cheapest, double longest, std::size_t limit,
           Json& left_out) {
    std::vector<std::pair<int, std::size_t>> order;
    for (std::size_t i = 0; i < r.sounds.rows.size(); ++i)
        order.emplace_back(place_of(r.sounds, i, cheapest), i);
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Json all = Json::array();
    std::size_t size = 0, too_many = 0;
    bool shortened = false;
    for (const auto& [place, row] : order) {
        const store::Sound sound =
            store::read_wav(sound_file(r, row), r.sounds.number(row, "peak"));
        Json one = json_of(sound, longest);
        const std::size_t more = one.at("samples").get_ref<const std::string&>().size();
        if (size + more > limit) {
            ++too_many;
            continue;
        }
        size += more;
        shortened = shortened || static_cast<double>(sound.samples.size()) > longest * sound.rate;
        one["row"] = row;
        all.push_back(std::move(one));
    }
    std::sort(all.begin(), all.end(),
              [](const Json& a, const Json& b) { return a.at("row") < b.at("row"); });
    if (shortened)
        left_out.push_back(
            fmt::format("Sounds end after {} s here; the files in sounds/ are whole.", longest));
    if (too_many > 0)
        left_out.push_back(fmt::format(
            "{} sounds are left out for the page's size; they lie in sounds/.", too_many));
    return all;
}

namespace {
namespace fs = std::filesystem;

constexpr const char* own_folders[] = {"cells", "sounds", "failures", "references", "scenes"};
constexpr const char* own_endings[] = {".csv", ".json", ".svg", ".html", ".toml", ".part"};

std::string what_is_in(const fs::path& folder) {  // "" if unknown
    try {
        const auto m = store::Folder{folder}.manifest();
        if (const std::string scene = trimmed_scene(m); !scene.empty()) return "trim of " + scene;
        if (m.contains("suite")) return "suite " + m.at("suite").get<std::string>();
        return "comparison of " + m.at("scene").at("name").get<std::string>();
    } catch (const std::exception&) { return ""; }
}

void must_be_ours(const fs::path& folder, const std::string& what,
                  const store::Listener& listener) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return;
    if (const std::string there = what_is_in(folder); !there.empty() && there != what)
        throw store::UsageError(
            fmt::format("--out {}: this folder holds the {}, and this is the {}; choose another "
                        "folder, or empty it",
                        folder.string(), there, what));
    std::vector<std::string> foreign;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename(), extension = entry.path().extension();
        const bool own = entry.is_directory(error)
                             ? std::find(std::begin(own_folders), std::end(own_folders), name) !=
                                   std::end(own_folders)
                             : std::find(std::begin(own_endings), std::end(own_endings),
                                         extension) != std::end(own_endings);
        if (!own && !name.starts_with(".")) foreign.push_back(name);
    }
    std::sort(foreign.begin(), foreign.end());
    if (foreign.empty()) return;
    std::string names;
    for (std::size_t k = 0; k < std::min<std::size_t>(foreign.size(), 5); ++k)
        names += (k > 0 ? ", " : "") + foreign[k];
    listener.note(
        fmt::format("{} holds what is not of the {}: {}{}", folder.string(), what, names,
                    foreign.size() > 5 ? fmt::format(" and {} more", foreign.size() - 5) : ""));
}

}  // namespace

OwnFolder::OwnFolder(const fs::path& folder, const std::string& what, const std::string& request,
                     const store::Listener& listener)
    : cells(folder.empty() ? folder : folder / "cells") {
    if (folder.empty()) return;
    must_be_ours(folder, what, listener);
    store::make_folder(cells);
    store::must_be_writable(folder / "cells.csv");
    store::must_be_writable(cells / "any.json");
    lock_.emplace(cells / "study.lock", what + ", request " + store::hash_of(request));
    if (const std::string& others = lock_->others(); !others.empty())
        throw store::UsageError(fmt::format(
            "--out {}: a process is at work there on {} {}, and its tables would be written over. "
            "Wait for its end, or choose another folder",
            folder.string(), others.starts_with(what + ",") ? "another" : "the",
            others.substr(0, others.rfind(','))));
    for (const char* own : own_folders) store::sweep_parts(folder / own);
}

void ResultsFolder::add(const std::string& name, const std::string& content) {
    if (folder_.empty()) return;
    store::write_fresh(folder_ / name, content);
    files.push_back((folder_ / name).string());
}

void ResultsFolder::add_tables(const study::Cells& cells) {
    using study::Contents;
    add("cells.csv", store::csv(study::table_of(cells, Contents::cells)));
    add("facts.csv", store::csv(study::table_of(cells, Contents::facts)));
    add("errors.csv", store::csv(study::errors_table(cells)));
    add("cost.csv", store::csv(study::table_of(cells, Contents::cost)));
    if (const store::Table orders = compare::convergence_table(cells); !orders.rows.empty())
        add("convergence.csv", store::csv(orders));
}

void ResultsFolder::add_manifest(const nlohmann::ordered_json& manifest) {
    add("manifest.json", store::indented(manifest) + "\n");
}

void ResultsFolder::add_report() {
    if (folder_.empty()) return;
    for (const std::string& name : write_report(folder_, listener_))
        files.push_back((folder_ / name).string());
}

Written written(const compare::Comparison& c, const compare::CompareRequest& request,
                const store::Listener& listener) {
    Written r{compare::manifest_of(c, request), compare::cells_of(c), {}, {}};
    r.cheapest = compare::cheapest_of(
        r.cells, request.controls ? compare::Controls::compete : compare::Controls::stand_beside);
    ResultsFolder folder(request.out, listener);
    folder.add_tables(r.cells);
    folder.add_manifest(r.manifest);
    if (folder) compare::write_sounds(c, request.out);
    folder.add_report();
    r.files = std::move(folder.files);
    return r;
}

}  // namespace jvari::bench::report
