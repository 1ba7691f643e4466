// Error against rate, with the observed order: of convergence.csv, else by analysis/convergence.hpp from the cells.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"
#include "bench/report/chart_data.hpp"
#include "bench/report/sections/page_sections.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;

struct Observed {
    std::string problem, series, error;
    Order order;
};

std::string text_of_order(double order, double half_width) {
    if (!std::isfinite(order)) return "";
    return std::isfinite(half_width) ? fmt::format("{:.2f} \u00b1 {:.2g}", order, half_width) : fmt::format("{:.2f}", order);
}

// From the cells: each series' error over its rates.
std::vector<Observed> observed_in(const WorkPrecision& w) {
    std::vector<Observed> all;
    std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> lines;
    std::vector<std::pair<std::string, std::string>> order;
    for (std::size_t i = 0; i < w.cells.rows.size(); ++i) {
        if (w.cells.at(i, "status") != "ok" || !(w.cells.number(i, "rate") > 0)) continue;
        const std::pair key{problem_of(w.cells, i), series_of(w.cells, i)};
        if (!lines.contains(key)) order.push_back(key);
        lines[key].push_back(i);
    }
    for (const auto& key : order)
        for (const Axis& a : w.errors) {
            std::vector<double> rates, errors;
            for (const std::size_t i : lines[key]) {
                rates.push_back(w.cells.number(i, "rate"));
                const compare::Bound b = compare::bound_of(w.cells, i, a.column);
                // a tie with the truth has no order, and one that is all wrong is not on its way to it
                const bool says = b.decides() && !(a.column.starts_with("error_l2_") && b.error >= 1);
                errors.push_back(says ? b.error : std::nan(""));
            }
            if (const Order o = observed_order(rates, errors); o.points >= 2) all.push_back({key.first, key.second, a.column, o});
        }
    return all;
}

// The column that a row of convergence.csv speaks of: window "50ms", tap "" or "nut".
std::string error_of(const store::Table& t, std::size_t i) {
    const std::string &window = t.at(i, "window"), &tap = t.at(i, "tap");
    const std::string error = window.rfind("error_", 0) == 0 || window.find("_db") != std::string::npos ? window : "error_l2_" + window;
    return error + (tap.empty() ? "" : "_" + tap);
}

Json orders_json(const Results& r, const std::vector<Observed>& observed) {
    Json orders = Json::object();
    for (const Observed& o : observed)
        orders[o.problem + "|" + o.series + "|" + o.error] = text_of_order(o.order.order, o.order.half_width);
    for (std::size_t i = 0; i < r.convergence.rows.size(); ++i)  // as measured for it, where it was
        orders[r.convergence.at(i, "problem") + "|" + r.convergence.at(i, "series") + "|" + error_of(r.convergence, i)] =
            text_of_order(r.convergence.number(i, "order"), r.convergence.number(i, "half_width"));
    return orders;
}

store::Table table_of(const std::vector<Observed>& observed, const std::string& headline, bool several_problems) {
    store::Table t{{"scene", "scheme", "error", "order", "half_width", "points"}, {}};
    for (const Observed& o : observed)
        if (o.error == headline || o.error == "error_l2_10ms" || o.error == "error_l2_whole" || o.error == "third_octave_db")
            t.rows.push_back({o.problem, o.series, o.error, fmt::format("{:.4f}", o.order.order), store::text_of(o.order.half_width),
                              std::to_string(o.order.points)});
    return several_problems ? t : t.only({"scheme", "error", "order", "half_width", "points"});
}

Filling filling_of(const WorkPrecision& w, const Json& orders, const std::string& problem) {
    Json titles = Json::object();
    for (const Axis& a : w.errors) titles[a.column] = a.title;
    return {problem + ": convergence",
            "error against sample rate; at the lines' ends the observed order, at the lower left those of 1 and 2",
            drawn_series(w.cells),
            {},
            {{"cells", chart_cells(w)}},
            {{"problem_field", json_text(problem)},
             {"measure_field", json_text(w.errors.front().measure)},
             {"tap_field", json_text(w.errors.front().tap)},
             {"titles", titles.dump()},
             {"orders", orders.dump()}}};
}
}  // namespace

Section convergence_section(const Results& r) {
    Section s{"convergence", "Convergence"};
    WorkPrecision w = work_precision_of(r);
    w.costs.clear();
    const auto observed = observed_in(w);
    if (observed.empty()) return s;
    const Json orders = orders_json(r, observed);
    std::vector<std::string> problems;
    for (const Observed& o : observed)
        if (std::find(problems.begin(), problems.end(), o.problem) == problems.end()) problems.push_back(o.problem);
    Chart c{"error against sample rate of each scheme",
            chart_of("convergence.json", filling_of(w, orders, problems.front()), Medium::page),
            false,
            problem_menu(problems),
            {}};
    for (Menu& m : error_menus(w.errors)) c.menus.push_back(std::move(m));
    c.offers = offers_of(w, problems);
    for (std::size_t k = 0; k < std::min(problems.size(), most_twins); ++k) {
        WorkPrecision own = w;
        own.cells = rows_where(w.cells, "problem", problems[k]);
        if (auto errors = error_axes(own.cells, {""}, compare::headline_error(own.cells, store::all_rows(own.cells))); !errors.empty())
            own.errors = std::move(errors);  // the default is one that the scene has
        c.twins.push_back({twin_file("convergence", problems[k], problems),
                           chart_of("convergence.json", filling_of(own, orders, problems[k]), Medium::print)});
    }
    s.charts.push_back(std::move(c));
    s.notes = {
        "The number at a line's end is the observed order p of error \u221d rate^\u2212p over the rates drawn; hover for its 95 % "
        "interval. "
        "The triangles at the lower left fall as orders 1 and 2 do. Near contact the order is about 1, and late windows saturate."};
    s.table = r.convergence.rows.empty() ? table_of(observed, w.errors.front().column, problems.size() > 1) : r.convergence;
    if (!r.convergence.rows.empty()) {
        s.table.columns.erase(s.table.columns.begin(), s.table.columns.begin() + 2);
        for (auto& row : s.table.rows) row.erase(row.begin(), row.begin() + 2);
    }
    return s;
}

}  // namespace jvari::bench::report
