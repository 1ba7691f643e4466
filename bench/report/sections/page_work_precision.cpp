// The first section: any cost against any error, problem by problem. And the cells it is drawn from, as a table.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/compare/bound.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/report/chart_data.hpp"
#include "bench/report/sections/page_sections.hpp"
#include "schemes/facts.hpp"

namespace jvari::bench::report {

namespace {
constexpr std::size_t most_cells_with_taps = 600;  // beyond, the headline errors alone can be chosen: the page stays small

// What the reference is certain to; NaN where points were measured against several, which a band cannot show.
double certificate_of(const store::Table& t, const std::string& problem, const std::string& error) {
    double least = HUGE_VAL, largest = -HUGE_VAL;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        if (problem_of(t, i) != problem) continue;
        const double c = compare::bound_of(t, i, error).certificate;
        least = std::fmin(least, c);
        largest = std::fmax(largest, c);
    }
    return least == largest ? largest : std::nan("");
}

// Of a scheme with several numbers of modes at one rate the cells that none of its others beats, as one series with the modes in its
// labels: what modes and rate come to together.
store::Table best_of_modes(store::Table t) {
    const std::string headline = compare::headline_error(t, store::all_rows(t));
    const auto name = [&t](std::size_t i) { return store::variant_name(t.at(i, "scheme"), t.at(i, "options")); };
    const auto several = [&](std::size_t i) { return series_of(t, i) != name(i); };
    const auto beaten = [&](std::size_t i) {
        const double cost = t.number(i, "cost_s_per_s"), error = compare::bound_of(t, i, headline).shown();
        for (std::size_t k = 0; k < t.rows.size(); ++k)
            if (k != i && compare::trusted(t, k) && problem_of(t, k) == problem_of(t, i) && name(k) == name(i) &&
                t.number(k, "cost_s_per_s") <= cost && compare::bound_of(t, k, headline).shown() < error)
                return true;
        return false;
    };
    std::vector<std::vector<std::string>> rows;
    const auto series = static_cast<std::size_t>(t.column("series"));
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        if (!several(i) || !(t.number(i, "cost_s_per_s") > 0)) {
            if (t.at(i, "status") != "not_needed") rows.push_back(t.rows[i]);
        } else if (!beaten(i)) {
            rows.push_back(t.rows[i]);
            rows.back()[series] = name(i);
        }
    }
    t.rows = std::move(rows);
    return t;
}

double known_floor(const Results& r, const std::string& problem, const std::string& error) {
    for (const auto& [name, value] : r.floors)
        if (name == error) return value;
    const std::string column = "floor_" + error;
    for (std::size_t i = 0; r.cells.column(column) >= 0 && i < r.cells.rows.size(); ++i)
        if (const double floor = r.cells.number(i, column); problem_of(r.cells, i) == problem && !std::isnan(floor)) return floor;
    return std::nan("");
}

// Of a suite: every text behind error_l2_whole_ in the columns.
std::vector<std::string> taps_of(const Results& r) {
    std::vector<std::string> taps{""};
    if (r.cells.rows.size() > most_cells_with_taps) return taps;
    const std::string stem = "error_l2_whole_";
    for (const std::string& name : r.cells.columns)
        if (name.rfind(stem, 0) == 0) taps.push_back(name.substr(stem.size()));
    return taps;
}

std::string goal_text(const store::Table& cheapest, std::size_t row) {
    const std::string &ties = cheapest.at(row, "ties"), &machine = cheapest.at(row, "machine");
    return compare::goal_name(cheapest, row) + ": " + cheapest.at(row, "run") + (ties.empty() ? "" : " or " + ties) +
           (machine.empty() ? "" : " (" + machine + ")");
}

// The goals that some cells of the problem reach and some do not, so that they lie among the points.
std::vector<Goal> goals_of(const Results& r) {
    std::vector<Goal> goals;
    for (const std::string& problem : distinct(r.cells, "problem")) {
        const store::Table own = rows_where(r.cells, "problem", problem),
                           cheapest = compare::cheapest_of(without_names(own), r.name, r.controls);
        for (std::size_t i = 0; i < cheapest.rows.size(); ++i) {
            const std::string& error = cheapest.at(i, "measure");
            const double most = cheapest.number(i, "target");
            bool missed = false;
            for (std::size_t k = 0; k < own.rows.size(); ++k)
                missed = missed || (own.at(k, "status") == "ok" && std::isfinite(own.number(k, error)) &&
                                    compare::bound_of(own, k, error).most() > most);
            if (missed && !cheapest.at(i, "scheme").empty()) goals.push_back({problem, error, most, goal_text(cheapest, i)});
        }
    }
    return goals;
}

Menu axis_menu(const char* label, const char* signal, const std::vector<Axis>& axes) {
    Menu m{label, signal, {}};
    for (const Axis& a : axes) m.choices.emplace_back(json_text(a.column), a.title);
    return m;
}

bool any_finite(const store::Table& t, const std::string& column) {
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (std::isfinite(t.number(i, column))) return true;
    return false;
}
}  // namespace

WorkPrecision work_precision_of(const Results& r) {
    WorkPrecision w;
    w.cells = r.cells;
    w.title = r.name + ": error and cost";
    w.controls = r.controls;
    w.subtitle = r.floors.empty() ? r.source : r.about.substr(0, r.about.rfind(';'));
    w.errors = error_axes(r.cells, taps_of(r), compare::headline_error(r.cells, store::all_rows(r.cells)));
    for (const Axis& a : cost_axes())
        if (any_finite(r.cells, a.column)) w.costs.push_back(a);
    for (const std::string& problem : distinct(r.cells, "problem"))
        for (const Axis& a : w.errors) {
            const Band b{problem, a.column, known_floor(r, problem, a.column), certificate_of(r.cells, problem, a.column)};
            if (!std::isnan(b.floor) || !std::isnan(b.certificate)) w.bands.push_back(b);
        }
    return w;
}

Section work_precision_section(const Results& r) {
    Section s{"work-precision", "Error and cost"};
    WorkPrecision w = work_precision_of(r);
    if (w.errors.empty() || w.costs.empty()) return s;
    w.cells = best_of_modes(w.cells);
    w.goals = goals_of(r);
    const auto problems = distinct(r.cells, "problem");
    Chart c{"error against cost of each scheme at each rate", "", false, problem_menu(problems), {}};
    for (Menu& m : error_menus(w.errors)) c.menus.push_back(std::move(m));
    c.menus.push_back(axis_menu("cost", "cost_field", w.costs));
    c.offers = offers_of(w, problems);
    w.medium = Medium::page;
    c.spec = work_precision_spec(w);
    w.medium = Medium::print;
    const std::string title = w.title;
    for (std::size_t k = 0; k < std::min(problems.size(), most_twins); ++k) {
        w.cells = best_of_modes(rows_where(r.cells, "problem", problems[k]));
        w.errors = error_axes(w.cells, {""}, compare::headline_error(w.cells, store::all_rows(w.cells)));
        if (problems.size() > 1) w.title = problems[k] + ": error and cost";
        if (!w.errors.empty()) c.twins.push_back({twin_file("work_precision", problems[k], problems), work_precision_spec(w)});
    }
    s.charts.push_back(std::move(c));
    const int flags = r.cells.column("flags");
    s.notes = {
        "Down is more accurate, left is cheaper. The grey track is the Pareto front; its points say their rates. Bars are quartiles of the "
        "cost. "
        "Crosses at the upper edge are runs that failed. Dotted lines are accuracies, with the cheapest that gets there.",
        "A hue is a family of schemes, a marker a scheme, a dash its options; thin grey lines are controls, known to be wrong somewhere. "
        "Click a name in the "
        "legend to bring it out, more names with it, or the empty chart for all."};
    if (std::any_of(r.cells.rows.begin(), r.cells.rows.end(), [&](const auto& row) { return flags >= 0 && !row[flags].empty(); }))
        s.notes.emplace_back("Hollow points are not to be trusted: the run's own figures speak against it. They are on no front.");
    if (const std::string several = store::machines_text(r.cells); !several.empty())
        s.notes.push_back("Each machine has a front of its own: " + several);
    if (!w.bands.empty())
        s.notes.emplace_back(
            "Points in the grey band cannot be told apart, because the problem is too sensitive. Points in the blue band are below the "
            "accuracy of the reference. If the uncertainty of the reference is more than a tenth of an error, it is added to it: the point "
            "is "
            "an upper bound.");
    return s;
}

Section cell_section(const Results& r) {
    Section s{"cells", "Cells", {"Each run, failures and refusals too."}};
    if (r.cells.column("pareto") >= 0) s.notes[0] += " Marked rows are on the Pareto front.";
    std::vector<std::string> columns;  // that say something
    for (std::size_t k = 0; k < r.cells.columns.size(); ++k)
        if (r.cells.columns[k] != "problem" && r.cells.columns[k] != "series" &&
            std::any_of(r.cells.rows.begin(), r.cells.rows.end(), [k](const auto& row) { return !row[k].empty(); }))
            columns.push_back(r.cells.columns[k]);
    s.table = r.cells.only(columns);
    const int from = s.table.column("scene"), to = s.table.column("scheme");
    if (from >= 0) s.first_columns.assign(s.table.columns.begin() + from, s.table.columns.begin() + to);
    for (const char* name : {"scheme", "options", "rate", "modes", "status", "flags", "error_l2_10ms", "error_l2_50ms", "error_l2_whole",
                             "horizon_s", "third_octave_db", "stft_db", "cost_s_per_s", "times_real_time", "ns_per_step",
                             "energy_residual_accumulated", facts::smallest_contact_force.name, facts::deepest_penetration.name, "reason"})
        if (s.table.column(name) >= 0) s.first_columns.emplace_back(name);
    if (s.table.rows.empty()) s.table = {};
    for (const std::string& name : s.table.columns) {
        if (!name.starts_with("error_")) continue;
        for (std::size_t i = 0; i < s.table.rows.size(); ++i) {
            const compare::Bound b = compare::bound_of(r.cells, i, name);
            if (b.says() == compare::Bound::Says::at_most || b.says() == compare::Bound::Says::unknown)
                s.shown.push_back({i, name, compare::error_text(b, "{:.2e}")});
        }
    }
    return s;
}

}  // namespace jvari::bench::report
