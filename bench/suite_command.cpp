// jvari suite: a declared set of comparisons and spectrograms. DIR gets cells/, cells.csv, errors.csv, cost.csv, manifest.json,
// spectrograms.svg where some were asked for, and report.html.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "bench/cheapest.hpp"
#include "bench/commands.hpp"
#include "bench/compare_record.hpp"
#include "bench/convergence_table.hpp"
#include "bench/figure_chart.hpp"
#include "bench/fresh_file.hpp"
#include "bench/machine.hpp"
#include "bench/map_command.hpp"
#include "bench/row_facet.hpp"
#include "bench/suite_run.hpp"
#include "bench/vega.hpp"

namespace jvari {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Table clock_only(const Table& cells) {  // what errors_only leaves out, beside what names the cell
    const Table rest = errors_only(cells);
    std::vector<std::string> names{"cell", "scene", "scheme", "rate", "modes", "status"};
    for (const std::string& name : cells.columns)
        if (rest.column(name) < 0) names.push_back(name);
    return cells.only(names);
}

std::string manifest_of(const Suite& suite, const SuitePlan& plan) {
    const Machine& m = machine();
    std::map<std::string, std::string> sources;
    for (const PlannedCell& c : plan.cells) sources[c.cell.scheme->name] = c.cell.scheme->source;
    return Json{{"program", "jvari"},         {"version", m.version},      {"commit", m.commit},  {"compiler", m.compiler},
                {"flags", m.flags},           {"build", m.build},          {"cpu", m.cpu},        {"cores", m.cores},
                {"system", m.system},         {"date", now_utc()},         {"suite", suite.name}, {"source", suite.source},
                {"cells", plan.cells.size()}, {"maps", suite.maps.size()}, {"schemes", sources}}
        .dump(2);
}

std::vector<Panel> panels_of(const SuitePlan& plan, const std::vector<SuiteRecord>& records) {
    std::set<double> rates;
    for (const PlannedCell& c : plan.cells)
        if (c.set->measures(Facet::spectrogram)) rates.insert(c.cell.settings.sample_rate);
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
        const PlannedCell& c = plan.cells[i];
        if (!c.set->measures(Facet::spectrogram)) continue;
        Panel p{c.point->scene.name, c.cell.scheme->name, records[i].row.at(0, "status"), records[i].levels};
        for (const auto& [key, value] : c.point->swept) p.across += fmt::format(", {} = {}", key, value);
        if (rates.size() > 1) p.down += fmt::format(" at {} Hz", c.cell.settings.sample_rate);
        if (c.cell.settings.modes > 0) p.down += fmt::format(", {} modes", c.cell.settings.modes);
        if (const std::string options = options_text(c.cell.settings); !options.empty()) p.down += ", " + options;
        panels.push_back(std::move(p));
    }
    return panels;
}

std::string escaped(const std::string& text) {
    std::string html;
    for (const char c : text) html += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
    return html;
}

std::string page_of(const Suite& suite, const Table& cells, const std::string& svg, const std::string& manifest) {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
        "<title>{0}</title>\n<style>:root{{color-scheme:light dark}}body{{font:15px/1.5 system-ui,'DejaVu Sans',sans-serif;margin:24px}}"
        ".scroll{{overflow:auto;max-height:70vh}}table{{border-collapse:collapse;font-size:13px}}th,td{{padding:4px 9px;text-align:left;"
        "white-space:nowrap;border-bottom:1px solid #8886}}</style></head>\n<body><h1>{0}</h1><p>{1}</p>\n",
        escaped(suite.name), escaped(suite.source));
    if (!svg.empty()) html += "<div style=\"overflow:auto\">" + svg + "</div>\n";
    std::vector<std::string> shown;  // columns that say something
    for (std::size_t k = 0; k < cells.columns.size(); ++k)
        if (std::any_of(cells.rows.begin(), cells.rows.end(), [k](const auto& row) { return !row[k].empty(); }))
            shown.push_back(cells.columns[k]);
    const Table table = cells.only(shown);
    html += "<div class=\"scroll\"><table><tr>";
    for (const std::string& name : table.columns) html += "<th>" + escaped(name) + "</th>";
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        html += "</tr>\n<tr>";
        for (std::size_t k = 0; k < table.columns.size(); ++k) {
            const std::string &name = table.columns[k], &field = table.rows[i][k];
            const double x = number_of(field);
            const bool shorten = field.size() > 9 && !std::isnan(x) && field.find('.') != std::string::npos;
            const bool below = x < certificate_of(table, i, name);
            html += "<td>" + escaped(below || shorten ? error_text(table, i, name, "{:.4g}") : field) + "</td>";
        }
    }
    return html + "</tr></table></div>\n<details><summary>Measured with</summary><pre>" + escaped(manifest) +
           "</pre></details></body></html>\n";
}

std::string table_text(const SuitePlan& plan, const SuiteRun& run) {
    std::string text;
    std::map<std::string, int> statuses;
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
        const Table& row = run.records[i].row;
        const PlannedCell& c = plan.cells[i];
        const auto short_text = [&row](const char* column, const char* format) {
            const double x = row.number(0, column);
            return std::isnan(x) ? std::string() : fmt::format(fmt::runtime(format), x);
        };
        ++statuses[row.at(0, "status")];
        std::string what = c.point->scene.name;
        for (const auto& [key, value] : c.point->swept) what += " " + key + "=" + value;
        const std::string options = options_text(c.cell.settings);
        text += fmt::format("  {:<36} {:<28} {:>8} {:>6}  {:<15} {:>9} {:>9}  {}\n", what,
                            c.cell.scheme->name + (options.empty() ? "" : " " + options), row.at(0, "rate"), row.at(0, "modes"),
                            row.at(0, "status"), error_text(row, 0, "error_l2_50ms", "{:.2e}"), short_text("cost_s_per_s", "{:.3g}"),
                            row.at(0, "reason"));
    }
    text = fmt::format("  {:<36} {:<28} {:>8} {:>6}  {:<15} {:>9} {:>9}\n", "scene", "scheme", "rate", "modes", "status", "L2 50ms",
                       "s per s") +
           text + fmt::format("{} cells, {} run, {} timed, {} read back:", plan.cells.size(), run.ran, run.timed, run.read_back);
    for (const auto& [status, count] : statuses) text += fmt::format(" {} {}", count, status);
    return text;
}

int exit_code(const std::vector<SuiteRecord>& records) {
    const auto is = [](const char* status) { return [status](const SuiteRecord& r) { return r.row.at(0, "status") == status; }; };
    if (records.empty() || std::any_of(records.begin(), records.end(), is("ok"))) return done;  // empty: a suite of maps alone
    return std::all_of(records.begin(), records.end(), is("refused")) ? refused : run_failed;
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder / "cells", error);
    if (!fs::is_directory(folder / "cells"))
        throw UsageError(fmt::format("--out {}: cannot make the folder: {}", folder.string(), error.message()));
    must_be_writable(folder / "cells.csv");
    must_be_writable(folder / "cells" / "any.json");
}
}  // namespace

int suite_command(const SuiteRequest& r) {
    const Console console(r.json, r.quiet);
    if (r.resume && r.out.empty()) throw UsageError("--resume: there is no --out DIR to resume from");
    const Suite suite = read_suite(r.suite);
    const Catalogue catalogue(r.plugins);
    const SuitePlan plan = plan_of(suite, catalogue, r.plugins);
    const fs::path folder = r.out;
    if (!r.out.empty()) make_folder(folder);
    const int jobs = r.jobs > 0 ? r.jobs : std::max(1u, std::thread::hardware_concurrency());
    const std::vector<std::string> mapped = chart_maps(suite, catalogue, r, jobs, console);
    const SuiteRun run = run_suite(plan, r.out.empty() ? fs::path() : folder / "cells", r.resume, jobs, console);
    const Table cells = table_of(plan, run.records);
    const std::string manifest = manifest_of(suite, plan);
    if (!plan.cells.empty()) console.print(suite.name + "\n" + table_text(plan, run));
    const Table cheapest = cheapest_of(cells);
    if (!cheapest.rows.empty()) console.print(cheapest_text(cheapest));

    Json files = mapped;
    if (!r.out.empty()) {
        const auto write = [&](const char* name, const std::string& content) {
            write_fresh(folder / name, content);
            files.push_back((folder / name).string());
        };
        if (!plan.cells.empty()) {
            write("cells.csv", csv(cells));
            write("errors.csv", csv(errors_only(cells)));
            write("cost.csv", csv(clock_only(cells)));
        }
        for (const RowFacet& f : row_facets())
            if (const Table rows = rows_of(f.facet, plan, run.records); !rows.rows.empty())
                write((std::string(name_of(f.facet)) + ".csv").c_str(), csv(rows));
        if (const Table orders = convergence_of(cells); !orders.rows.empty()) write("convergence.csv", csv(orders));
        write("manifest.json", manifest + "\n");
        for (const DrawnFigure& f : draw_figures(suite, plan, run.records, cells, console)) write(f.file.c_str(), f.svg);
        std::string svg;
        if (const auto panels = panels_of(plan, run.records); !panels.empty()) {
            const Vega vega = find_vega();
            std::string why = vega.missing;
            std::string tap = plan.points.front().scene.taps.at(plan.points.front().tap).name;
            const std::string spec = spectrogram_spec(suite.name, fmt::format("spectrograms of {}; {}", tap, suite.source), panels);
            if (why.empty()) svg = svg_of(vega, spec, why).value_or("");
            if (svg.empty()) console.note(why);
            else write("spectrograms.svg", svg);
        }
        write("report.html", page_of(suite, cells, svg, manifest));
        console.print("written: " + folder.string());
    }
    const int code = exit_code(run.records);
    const char* status = code == done ? "ok" : code == refused ? "refused" : "failed";
    console.print_json(Json{
        {"suite", suite.name},
        {"status", status},
        {"ran", run.ran},
        {"timed", run.timed},
        {"read_back", run.read_back},
        {"manifest", Json::parse(manifest)},
        {"cells", Json::parse(rows_json(cells))},
        {"cheapest", Json::parse(rows_json(cheapest))},
        {"files", files}}.dump(2));
    return code;
}

}  // namespace jvari
