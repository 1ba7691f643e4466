#include "bench/report/results.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/study/errors.hpp"

namespace jvari::bench::report {

namespace {
using store::Table;
using study::Rows;
using Cell = study::TabledCell;

// Beyond this many cells, orders are computed only for headline errors.
constexpr std::size_t most_cells_with_taps = 600;

// Names the line for each cell. If a scheme ran with several numbers of modes at the same rate, its
// unbeaten cells form a single line, showing the combined effect of modes and rate. A cell is
// beaten if a trusted cell by the same scheme has a smaller error at the same or lower cost.
std::vector<std::string> lines_of(const Results& r) {
    const std::size_t headline = compare::headline_error(r.cells, study::all_rows(r.cells));
    const auto shown = [&](const Cell& c) { return compare::bound_of(c, headline).shown(); };
    const auto beaten = [&](const Cell& c) {
        return std::ranges::any_of(r.cells, [&](const Cell& k) {
            return &k != &c && compare::trusted(k) && k.same_series(c) &&
                   k.cost_s_per_s <= c.cost_s_per_s && shown(k) < shown(c);
        });
    };
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < r.cells.size(); ++i) {
        const Cell& c = r.cells[i];
        if (r.series[i] == c.variant() || !(c.cost_s_per_s > 0))
            lines.push_back(c.status == "not_needed" ? "" : r.series[i]);
        else lines.push_back(beaten(c) ? "" : c.variant());
    }
    return lines;
}

Table cells_table(const Results& r, const std::vector<std::string>& lines) {
    Table t = study::table_of(r.cells, study::Contents::everything);
    t.columns.insert(t.columns.begin(), {"problem", "series"});
    t.columns.insert(t.columns.end(), {"trusted", "may_win", "line"});
    for (std::size_t i = 0; i < r.cells.size(); ++i) {
        const Cell& c = r.cells[i];
        t.rows[i].insert(t.rows[i].begin(), {c.problem(), r.series[i]});
        t.rows[i].insert(t.rows[i].end(),
                         {compare::trusted(c), compare::may_win(c, r.controls), lines[i]});
    }
    return t;
}

struct ErrorName {
    std::size_t measure;
    std::string tap;  // "": the headline's tap
};
std::vector<ErrorName> errors_in(const study::Cells& cells) {
    std::vector<std::string> taps{""};
    for (const Cell& c : cells)
        for (const std::string& tap : c.taps)
            if (cells.size() <= most_cells_with_taps && std::ranges::find(taps, tap) == taps.end())
                taps.push_back(tap);
    std::vector<ErrorName> errors;
    for (const std::string& tap : taps)
        for (std::size_t m = 0; m < study::measures().size(); ++m)
            if (study::measures()[m].less_is_better) errors.push_back({m, tap});
    return errors;
}

Table figures_table(const study::Cells& cells) {
    Table t{{"row", "tap", "measure", "value", "floor", "certificate", "shown", "text"}, {}};
    for (const auto& [m, tap] : errors_in(cells))
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const study::Figure& f = cells[i].figure(m, tap);
            if (std::isnan(f.value) && std::isnan(f.floor) && std::isnan(f.certificate)) continue;
            const compare::Bound b = compare::bound_of(cells[i], m, tap);
            const bool bounded =
                study::is_waveform(m) && (b.says() == compare::Bound::Says::at_most ||
                                          b.says() == compare::Bound::Says::unknown);
            t.rows.push_back({i, tap, study::measures()[m].column, f.value, f.floor, f.certificate,
                              bounded ? b.shown() : nan,
                              bounded ? compare::error_text(b, "{:.2e}") : ""});
        }
    return t;
}

Table scenes_table(const study::Cells& cells) {
    Table t{{"problem", "headline", "certificate", "busy"}, {}};
    for (const Rows& rows : study::by_problem(cells, study::all_rows(cells))) {
        const std::size_t headline = compare::headline_error(cells, rows);
        study::Cells own;
        for (const std::size_t i : rows) own.push_back(cells[i]);
        t.rows.push_back({own[0].problem(), study::measures()[headline].column,
                          compare::bound_of(own[0], headline).certificate,
                          compare::busy_text(own)});
    }
    return t;
}

Table cheapest_table(const Results& r) {
    const auto answers = compare::cheapest_of(r.cells, r.controls);
    Table t = compare::table_of(answers, r.cells);
    for (std::size_t i = 0; i < answers.size(); ++i)
        t.rows[i].insert(t.rows[i].begin(), r.cells[answers[i].of].problem());
    t.columns.insert(t.columns.begin(), "problem");
    return t;
}

// Excludes ties with the reference, because they have no order, and cells with a completely wrong
// result, because they are not converging yet.
Table orders_of(const Results& r) {
    Table t{{"problem", "series", "tap", "measure", "order", "half_width", "points"}, {}};
    Rows ended = study::all_rows(r.cells);
    std::erase_if(
        ended, [&](std::size_t i) { return r.cells[i].status != "ok" || !(r.cells[i].rate > 0); });
    const auto line = [&](std::size_t i) { return r.cells[i].problem() + "|" + r.series[i]; };
    const auto errors = errors_in(r.cells);
    for (const Rows& rows : study::alike(ended, line))
        for (const auto& [measure, tap] : errors)
            if (const Order o = compare::fall_over_rates(r.cells, rows, measure, tap).order;
                o.points >= 2)
                t.rows.push_back({r.cells[rows[0]].problem(), r.series[rows[0]], tap,
                                  study::measures()[measure].column, o.order, o.half_width,
                                  o.points});
    return t;
}
}  // namespace

std::map<std::string, Table> tables_of(const Results& r) {
    std::map<std::string, Table> tables = r.tables;
    if (r.cells.empty()) return tables;
    tables["cells"] = cells_table(r, lines_of(r));
    tables["errors"] = figures_table(r.cells);
    tables["scenes"] = scenes_table(r.cells);
    tables["cheapest"] = cheapest_table(r);
    tables["orders"] = orders_of(r);
    return tables;
}

}  // namespace jvari::bench::report
