// Error against what a suite sweeps: a chart per key that takes several numbers, a line per scheme, one rate at a time. What else is swept
// tells lines apart. Numbers of modes are such a key for schemes that have several at one rate: a grid takes another with each rate.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/compare/bound.hpp"
#include "bench/report/chart_data.hpp"
#include "bench/report/sections/page_sections.hpp"
#include "bench/store/cell_rows.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;

bool is_swept(const store::Table& t, const std::string& key) {  // over two numbers at least
    const auto values = distinct(t, key);
    return std::ranges::count_if(values, [](const std::string& v) { return std::isfinite(store::number_of(v)); }) > 1;
}

// Rows along a key: those that have a number there. Modes no longer tell series apart where they are the key.
WorkPrecision along(WorkPrecision w, const std::string& key) {
    const int at = w.cells.column(key), scheme = w.cells.column("scheme"), options = w.cells.column("options"),
              series = w.cells.column("series");
    std::erase_if(w.cells.rows, [&](auto& row) {
        if (!std::isfinite(store::number_of(row[at]))) return true;
        if (key != "modes") return false;
        const std::string name = store::variant_name(row[scheme], options < 0 ? "" : row[options]);
        const bool alone = row[series] == name;  // one number of modes at each rate
        row[series] = name;
        return alone;
    });
    return w;
}

// The rows of the charts with what places them: `base`, the scene; `at`, the value of the key; `others`, the values of other keys.
Json rows_along(const WorkPrecision& w, const std::vector<std::string>& keys, const std::string& key, const std::string& scene) {
    Json rows = Json::parse(chart_cells(w));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::string others;
        for (const std::string& other : keys)
            if (other != key && !w.cells.at(i, other).empty())
                others += (others.empty() ? "" : ", ") + other + " = " + w.cells.at(i, other);
        rows[i].update(
            {{"base", w.cells.column("scene") < 0 ? scene : w.cells.at(i, "scene")}, {"at", w.cells.number(i, key)}, {"others", others}});
    }
    return rows;
}

Filling filling_of(const WorkPrecision& w, const Json& rows, const std::string& key, const std::string& base, double rate) {
    Json titles = Json::object();
    for (const Axis& a : w.errors) titles[a.column] = a.title;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (std::size_t i = 0; i < w.cells.rows.size(); ++i) {
        least = std::fmin(least, w.cells.number(i, key));
        most = std::fmax(most, w.cells.number(i, key));
    }
    return {base + ": error along " + key,
            rate_text(rate),
            drawn_series(w.cells),
            {{"@scale_x", least > 0 && most > 5 * least ? "log" : "linear"}, {"@title_x", with_unit(key)}},
            {{"rows", rows.dump()}},
            {{"base_field", json_text(base)},
             {"rate_field", store::text_of(rate)},
             {"measure_field", json_text(w.errors.front().measure)},
             {"tap_field", json_text(w.errors.front().tap)},
             {"titles", titles.dump()}}};
}
}  // namespace

Section sweep_section(const Results& r) {
    Section s{"sweep", "Error along what is swept"};
    WorkPrecision w = work_precision_of(r);
    if (w.errors.empty()) return s;
    w.costs.clear();
    std::erase_if(w.cells.rows, [&w](const auto& row) { return row[w.cells.column("status")] == "refused"; });
    auto keys = store::swept_keys(without_names(r.cells));
    const bool scenes = !keys.empty();
    keys.emplace_back("modes");
    for (const std::string& key : keys) {
        WorkPrecision own = along(w, key);
        if (!is_swept(own.cells, key)) continue;
        own.errors = error_axes(own.cells, {""}, compare::headline_error(own.cells, store::all_rows(own.cells)));
        if (own.errors.empty()) continue;
        const Json rows = rows_along(own, keys, key, r.name);
        std::vector<std::string> bases;
        std::vector<double> rates;
        for (const Json& row : rows) {
            if (std::find(bases.begin(), bases.end(), row["base"]) == bases.end()) bases.push_back(row["base"]);
            if (row["rate"].is_number() && std::find(rates.begin(), rates.end(), row["rate"]) == rates.end()) rates.push_back(row["rate"]);
        }
        if (rates.empty()) continue;
        std::sort(rates.begin(), rates.end());
        Chart c{"error along " + key, chart_of("sweep.json", filling_of(own, rows, key, bases.front(), rates.front()), Medium::page)};
        Menu scene{"string", "base_field", {}}, rate{"rate", "rate_field", {}};
        for (const std::string& base : bases) scene.choices.emplace_back(json_text(base), base);
        for (const double hz : rates) rate.choices.emplace_back(store::text_of(hz), rate_text(hz));
        c.menus = {scene, rate};
        for (Menu& m : error_menus(own.errors)) c.menus.push_back(std::move(m));
        for (const std::string& base : bases)
            if (c.twins.size() < most_twins)
                c.twins.push_back({twin_file("sweep-" + file_part(key, keys), base, bases),
                                   chart_of("sweep.json", filling_of(own, rows, key, base, rates.front()), Medium::print)});
        s.charts.push_back(std::move(c));
    }
    if (!s.charts.empty())
        s.notes = {fmt::format("{}Hollow points are not to be trusted.",
                               scenes ? "Each value of a scene's key is a scene of its own, with a reference of its own. " : "")};
    return s;
}

}  // namespace jvari::bench::report
