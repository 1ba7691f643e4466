#include "bench/report.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/charts.hpp"
#include "bench/fresh_file.hpp"
#include "bench/records.hpp"
#include "bench/report_page.hpp"
#include "bench/vega.hpp"

namespace jvari {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

WorkPrecision work_precision_of(const Table& cells, const Json& manifest) {
    WorkPrecision w;
    w.cells = cells;
    const Json &scene = manifest.at("scene"), &reference = manifest.at("reference"), &headline = manifest.at("headline");
    std::vector<std::string> taps{""};
    for (const Json& tap : scene.at("taps")) taps.push_back(tap.at("name"));
    w.errors = error_axes(cells, taps, headline.at("error"));
    w.costs = cost_axes();
    for (const auto& [name, value] : manifest.at("noise_floor").items())
        if (value.is_number()) w.floors.emplace_back(name, value.get<double>());
    double lowest = HUGE_VAL;
    for (std::size_t i = 0; i < cells.rows.size(); ++i) lowest = std::fmin(lowest, cells.number(i, "rate"));
    w.title = fmt::format("{}: error and cost", scene.at("name").get<std::string>());
    w.subtitle =
        fmt::format("against {}, {} s; nut tap {}, bridge tap {}{}", reference.at("name").get<std::string>(),
                    scene.at("duration").get<double>(), headline.at("nut").get<std::string>(), headline.at("bridge").get<std::string>(),
                    std::isfinite(lowest) ? fmt::format("; \u00d71 = {:.6g} kHz", lowest / 1000) : "");
    return w;
}

Json table_json(const Table& t) {
    return {{"columns", t.columns}, {"rows", t.rows}};
}
}  // namespace

std::vector<std::string> write_report(const fs::path& folder, const Console& console) {
    const Table cells = [&folder] {
        try {
            return read_csv(read_whole(folder / "cells.csv"));
        } catch (const UsageError&) {
            throw;
        } catch (const std::runtime_error& e) {
            throw UsageError(fmt::format("{}: {}", (folder / "cells.csv").string(), e.what()));
        }
    }();
    Json manifest;
    WorkPrecision chart;
    try {
        manifest = Json::parse(read_whole(folder / "manifest.json"));
        chart = work_precision_of(cells, manifest);
    } catch (const Json::exception& e) {
        throw UsageError(fmt::format("{}: {}", (folder / "manifest.json").string(), e.what()));
    }
    must_be_writable(folder / "report.html");

    std::vector<std::string> written;
    const Vega vega = find_vega();
    Page page;
    page.title = chart.title;
    page.manifest = manifest.dump();
    page.table = table_json(cells).dump();
    page.missing = vega.missing;
    if (vega.missing.empty()) {
        std::string why;
        if (const auto svg = svg_of(vega, work_precision_spec(chart), why)) {
            write_fresh(folder / "work_precision.svg", *svg);
            written.emplace_back("work_precision.svg");
        } else {
            console.note(why);
        }
        chart.wide = true;
        page.spec = work_precision_spec(chart);
        page.scripts = vega_scripts(vega).value_or("");
    } else {
        console.note(vega.missing);
    }
    Json errors = Json::array(), costs = Json::array();
    for (const Axis& a : chart.errors) errors.push_back({a.column, a.title});
    for (const Axis& a : chart.costs) costs.push_back({a.column, a.title});
    page.choices = Json{{"errors", errors}, {"costs", costs}}.dump();
    write_fresh(folder / "report.html", page_of(page));
    written.emplace_back("report.html");
    return written;
}

}  // namespace jvari
