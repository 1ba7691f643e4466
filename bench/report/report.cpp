#include "bench/report/report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/report/results.hpp"
#include "bench/report/vega.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/study/errors.hpp"
#include "bench/study/record.hpp"
#include "reference/references.hpp"
#include "schemes/controls.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;

// Size limits for parts of a page [bytes].
constexpr std::size_t page_limit = 4'900'000, sounds_limit = 3'000'000, table_limit = 1'500'000;
constexpr double longest_heard = 4;  // [s]

}  // namespace

store::Table fitting(store::Table t, Json& left_out) {
    // bytes, column number
    std::vector<std::pair<std::size_t, std::size_t>> columns(t.columns.size());
    std::size_t all = 0;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        for (const auto& row : t.rows) columns[k].first += row[k].text().size() + 1;
        columns[k].second = k;
        all += columns[k].first;
    }
    if (all <= table_limit) return t;
    std::sort(columns.rbegin(), columns.rend());
    std::vector<bool> kept(columns.size(), true);
    const auto needed = [&](const std::string& name) {
        return std::ranges::any_of(
            std::initializer_list<const char*>{
                "problem",   "series",    "cell",      "scene",      "scheme",   "options",
                "rate",      "modes",     "status",    "flags",      "error_l2", "third_octave",
                "cost",      "ns_per",    "map",       "x",          "y",        "outcome",
                "row",       "tap",       "measure",   "value",      "floor",    "certificate",
                "shown",     "text",      "order",     "half_width", "points",   "trusted",
                "may_win",   "run",       "line",      "target",     "worst_",   "headline",
                "free_from", "fact_grid", "fact_refer"},
            [&](const char* start) { return name.starts_with(start); });
    };
    for (const auto& [bytes, k] : columns)
        if (all > table_limit && !needed(t.columns[k])) {
            kept[k] = false;
            all -= bytes;
        }
    std::vector<std::string> names;
    for (std::size_t k = 0; k < kept.size(); ++k)
        if (kept[k]) names.push_back(t.columns[k]);
    left_out.push_back(
        "The table holds the most asked-for columns; all are in the csv file beside the page.");
    return t.only(names);
}

namespace {
// Shortens a large table: taps other than the headline's keep only the most requested errors.
void shorten_errors(store::Table& t, Json& left_out) {
    std::size_t size = 0;
    for (const auto& row : t.rows)
        for (const store::Field& field : row) size += field.text().size() + 1;
    if (size <= table_limit) return;
    const auto tap = t.column("tap"), measure = t.column("measure");
    std::erase_if(t.rows, [&](const auto& row) {
        return !row[tap].empty() && row[measure] != "third_octave_db" &&
               !study::is_waveform(study::measure(row[measure].text()));
    });
    left_out.push_back(
        "Charts of single taps have waveforms and third octaves; all errors are in "
        "errors.csv beside the page.");
}

Json measures() {
    Json all = Json::array();
    for (const study::Measure& m : study::measures())
        if (m.less_is_better) all.push_back({m.column, m.axis(), m.title, m.unit, name_of(m.kind)});
    return all;
}

// Answers of each problem for each error, where they change: [tolerance, best, ties, perhaps] with
// rows of the table of cells. The page looks an answer up.
Json answers(const Results& r) {
    Json all = Json::object();
    for (const study::Rows& rows : study::by_problem(r.cells, study::all_rows(r.cells))) {
        const study::TabledCell& first = r.cells[rows.front()];
        std::vector<std::string> taps{""};
        taps.insert(taps.end(), first.taps.begin(), first.taps.end());
        for (std::size_t m = 0; m < study::measures().size(); ++m)
            for (const std::string& tap : taps)
                for (const auto& [from, choice] :
                     compare::answers_along(r.cells, rows, m, tap, r.controls))
                    all[first.problem()]
                       [study::measures()[m].column + std::string(tap.empty() ? "" : "_") + tap]
                           .push_back({from, choice.best ? Json(*choice.best) : Json(), choice.ties,
                                       choice.perhaps});
    }
    return all;
}

// Levels for the cells with spectrograms, and for the references that were played.
Json kept_levels(const Results& r) {
    Json all = Json::array();
    for (std::size_t i = 0; i < r.cells.size(); ++i)
        if (const auto kept =
                study::read_levels(r.folder / "cells" / (r.cells[i].cell + ".json"), "spectrogram"))
            all.push_back(json_of(*kept)), all.back()["cell"] = i;
    if (all.empty()) return all;
    for (std::size_t i = 0; i < r.sounds.rows.size(); ++i) {
        if (r.sounds.at(i, "scheme") != "reference") continue;
        const store::Sound sound = store::read_wav(sound_file(r, i), r.sounds.number(i, "peak"));
        std::vector<double> signal;
        for (const int x : sound.samples) signal.push_back(x * sound.peak / 32767);
        all.push_back(json_of(study::levels_of(signal, sound.rate)));
        all.back()["problem"] = r.sounds.text(i, "problem");
    }
    return all;
}

}  // namespace

Json values_of(const Results& r, const std::map<std::string, store::Table>& tables) {
    Json values{{"source", r.source}, {"command", r.command}, {"measures", measures()}};
    values["units"] = units();
    values["manifest"] = store::parsed(r.manifest);
    values["quantities"] = quantities_in(values["manifest"]);
    values["trimmed"] = trimmed_scene(values["manifest"]);
    values["options"] = values["tables"] = Json::object();
    for (const auto& [name, table] : tables) {
        if (table.columns.empty()) continue;
        for (std::size_t i = 0; table.column("options") >= 0 && i < table.rows.size(); ++i)
            values["options"][table.text(i, "options")] =
                store::options_in(table.text(i, "options"));
        values["tables"][name] = store::table_json(table);
    }
    values["answers"] = answers(r);
    values["warnings"] = compare::warnings_of(r.cells);
    return values;
}

Json data_of(const Results& r, std::map<std::string, store::Table> tables) {
    const auto behind = [&r](const std::string& text) {
        return r.source + (r.source.empty() || text.empty() ? "" : " \u2014 ") + text;
    };
    Json data = empty_data(r.name, behind(r.about + (r.about.empty() ? "" : "; ") + r.date));
    data["undated"] = behind(r.about);
    data["sounds"] =
        heard(r, tables["cheapest"], longest_heard, sounds_limit, data["left_out"]["sounds"]);
    data["levels"] = kept_levels(r);
    shorten_errors(tables["errors"], data["left_out"]["cells"]);
    for (auto& [name, table] : tables) table = fitting(std::move(table), data["left_out"]["cells"]);
    data.update(values_of(r, tables));
    return data;
}

nlohmann::ordered_json empty_data(const std::string& title, const std::string& about) {
    const Json none = Json::array();
    Json known = none;
    for (const auto& list : {schemes(), references()})
        for (const Descriptor& d : list) known.push_back({d.name, is_control(d)});
    Json data{{"title", title},
              {"about", about},
              {"schemes", known},
              {"tables", Json::object()},
              {"options", Json::object()},
              {"answers", Json::object()},
              {"units", Json::object()},
              {"quantities", Json::object()},
              {"manifest", Json::object()}};
    for (const char* text : {"undated", "source", "trimmed", "command", "missing"}) data[text] = "";
    for (const char* list : {"measures", "sounds", "levels"}) data[list] = none;
    for (const char* of : {"cells", "sounds"}) data["left_out"][of] = none;
    return data;
}

std::string fitting_page_of(Json data, const std::string& scripts, std::size_t limit) {
    const std::string html = page_of(data, scripts);
    std::size_t excess = html.size() > limit ? html.size() - limit + 2000 : 0;
    if (excess == 0) return html;
    Json& sounds = data["sounds"];
    std::size_t count = 0;
    for (; excess > 0 && !sounds.empty(); ++count) {
        excess -=
            std::min(excess, sounds.back().at("samples").get_ref<const std::string&>().size());
        sounds.erase(sounds.size() - 1);
    }
    if (count > 0)
        data["left_out"]["sounds"].push_back(fmt::format(
            "{} more sounds are left out for the page's size; they lie beside it.", count));
    return page_of(data, scripts);
}

Results best_of(const Results& r, std::size_t cells) {
    const std::size_t headline = compare::headline_error(r.cells, study::all_rows(r.cells));
    std::vector<char> first(r.cells.size());
    std::map<std::string, std::pair<double, std::size_t>> best;  // for a scheme on a problem
    for (const compare::Answer& a : compare::cheapest_of(r.cells, r.controls))
        if (a.cell) first[*a.cell] = true;
    for (std::size_t i = 0; i < r.cells.size(); ++i) {
        const study::TabledCell& c = r.cells[i];
        const double shown = compare::bound_of(c, headline).shown();
        auto& [least, place] =
            best.try_emplace(c.problem() + "|" + c.scheme, HUGE_VAL, i).first->second;
        if (shown < least) least = shown, place = i;
        first[i] = first[i] || c.pareto == true;
    }
    for (const auto& [who, of] : best) first[of.second] = true;
    study::Rows order = study::all_rows(r.cells);
    std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return first[i]; });
    order.resize(std::min(cells, order.size()));
    std::ranges::sort(order);
    Results some = r;
    some.cells.clear();
    some.series.clear();
    for (const std::size_t i : order) {
        some.cells.push_back(r.cells[i]);
        some.series.push_back(r.series[i]);
    }
    return some;
}

std::string fitting_page_of(const Results& r, Json data, const std::string& scripts,
                            std::size_t limit) {
    const std::string missing = data["missing"];
    std::string html = fitting_page_of(data, scripts, limit);
    std::size_t kept = r.cells.size();
    while (html.size() > limit && kept > 1) {
        const double share = 0.8 * static_cast<double>(limit) / static_cast<double>(html.size());
        kept =
            std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(kept)));
        const Results best = best_of(r, kept);
        data = data_of(best, tables_of(best));
        data["missing"] = missing;
        data["left_out"]["cells"].push_back(
            fmt::format("{} of {} cells are in this page: those that answer, and the best of each "
                        "scheme, come first. All are in the csv files beside it.",
                        kept, r.cells.size()));
        html = fitting_page_of(data, scripts, limit);
    }
    while (html.size() > limit && !data["tables"].empty()) {
        const auto largest = std::max_element(
            data["tables"].begin(), data["tables"].end(), [](const Json& a, const Json& b) {
                return store::compact(a).size() < store::compact(b).size();
            });
        data["left_out"]["cells"].push_back(
            fmt::format("The table {} is left out for the page's size; {}.csv lies beside it.",
                        largest.key(), largest.key()));
        data["tables"].erase(largest);
        html = fitting_page_of(data, scripts, limit);
    }
    return html;
}

std::vector<std::string> write_report(const fs::path& folder, const store::Listener& listener,
                                      double width) {
    const Results results = read_results(folder);
    store::must_be_writable(folder / "report.html");
    const auto tables = tables_of(results);
    auto kept = tables;  // with every error, as read_cells reads it
    if (!results.cells.empty()) kept["errors"] = study::errors_table(results.cells);
    store::write_fresh(folder / "results.json", store::compact(values_of(results, kept)) + "\n");
    Json data = data_of(results, tables);
    const Vega vega = find_vega();
    std::vector<std::string> written{"results.json"};
    std::string scripts;
    if (vega.missing.empty()) {
        scripts = vega_scripts(vega).value_or("");
        Json drawing = data;
        if (width > 0) drawing["width"] = width * pixels_per_mm;
        const Drawn drawn = draw(vega, drawing);
        for (const auto& [name, svg] : drawn.svgs) {
            store::write_fresh(folder / name, svg);
            written.push_back(name);
        }
        for (const std::string& note : drawn.notes) listener.note(note);
    } else {
        listener.note(vega.missing);
        data["missing"] = vega.missing;
    }
    store::write_fresh(folder / "report.html",
                       fitting_page_of(results, std::move(data), scripts, page_limit));
    written.emplace_back("report.html");
    return written;
}

}  // namespace jvari::bench::report
