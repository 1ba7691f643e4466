#include "bench/report/derived.hpp"

#include <algorithm>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/record/notes.hpp"
#include "bench/compare/record/pareto.hpp"
#include "bench/study/errors.hpp"

namespace jvari::bench::report {

namespace {
using store::Rows;
using store::Table;

// beyond, fronts and orders are of the headline errors alone
constexpr std::size_t most_cells_with_taps = 600;

Table rows_where(const Table& t, const std::string& column, const std::string& text) {
    Table rows{t.columns, {}};
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (t.at(i, column) == text) rows.rows.push_back(t.rows[i]);
    return rows;
}

// Of a scheme with several numbers of modes at one rate the cells that none of its others beats are
// one line: what modes and rate come to together.
std::vector<std::string> lines_of(const Table& t) {
    const std::string headline = compare::headline_error(t, store::all_rows(t));
    const auto name = [&t](std::size_t i) {
        return store::variant_name(t.at(i, "scheme"), t.at(i, "options"));
    };
    const auto beaten = [&](std::size_t i) {
        const double cost = t.number(i, "cost_s_per_s"),
                     error = compare::bound_of(t, i, headline).shown();
        for (std::size_t k = 0; k < t.rows.size(); ++k)
            if (k != i && compare::trusted(t, k) && t.at(k, "problem") == t.at(i, "problem") &&
                name(k) == name(i) && t.number(k, "cost_s_per_s") <= cost &&
                compare::bound_of(t, k, headline).shown() < error)
                return true;
        return false;
    };
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const bool several = t.at(i, "series") != name(i);
        if (!several || !(t.number(i, "cost_s_per_s") > 0))
            lines.push_back(t.at(i, "status") == "not_needed" ? "" : t.at(i, "series"));
        else lines.push_back(beaten(i) ? "" : name(i));
    }
    return lines;
}

Table judged_of(const Results& r, const std::vector<std::string>& lines) {
    Table t{{"trusted", "may_win", "run", "line"}, {}};
    const auto yes = [](bool holds) { return holds ? std::string("1") : ""; };
    for (std::size_t i = 0; i < r.cells.rows.size(); ++i)
        t.rows.push_back({yes(compare::trusted(r.cells, i)),
                          yes(compare::may_win(r.cells, i, r.controls)),
                          store::run_name(r.cells, i), lines[i]});
    return t;
}

Table bounds_of(const Table& cells) {
    Table t{{"row", "column", "shown", "text"}, {}};
    for (const std::string& column : cells.columns)
        for (std::size_t i = 0; column.starts_with("error_") && i < cells.rows.size(); ++i) {
            const compare::Bound b = compare::bound_of(cells, i, column);
            if (b.says() == compare::Bound::Says::at_most ||
                b.says() == compare::Bound::Says::unknown)
                t.rows.push_back({std::to_string(i), column, store::text_of(b.shown()),
                                  compare::error_text(b, "{:.2e}")});
        }
    return t;
}

Table scene_of(const Table& own, const std::string& problem) {
    const std::string headline = compare::headline_error(own, store::all_rows(own));
    return {{"problem", "headline", "certificate", "spread", "busy"},
            {{problem, headline, store::text_of(compare::bound_of(own, 0, headline).certificate),
              store::text_of(compare::median_spread(own)), compare::busy_text(own)}}};
}

Table cheapest_in(const Results& r, const Table& own, const std::string& problem) {
    // without problem and series
    const Table plain = own.only({own.columns.begin() + 2, own.columns.end()});
    Table t = compare::cheapest_of(plain, r.controls);
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const std::string goal = compare::goal_name(t, i);
        t.rows[i].insert(t.rows[i].begin(), {problem, goal});
    }
    t.columns.insert(t.columns.begin(), {"problem", "goal"});
    return t;
}

void append(Table& whole, Table part) {
    whole.columns = std::move(part.columns);
    std::ranges::move(part.rows, std::back_inserter(whole.rows));
}

std::vector<std::string> errors_in(const Table& cells) {
    std::vector<std::string> taps{""}, errors;
    for (const std::string& name : cells.columns)
        if (name.starts_with("error_l2_whole_") && cells.rows.size() <= most_cells_with_taps)
            taps.push_back(name.substr(14));
    for (const std::string& tap : taps)
        for (const study::Measure& m : study::measures())
            if (m.less_is_better && cells.column(m.column + tap) >= 0)
                errors.push_back(m.column + tap);
    return errors;
}

Table fronts_of(const Results& r, const std::vector<std::string>& lines) {
    Table t{{"problem", "row", "error", "cost"}, {}};
    Rows rivals = store::all_rows(r.cells);
    std::erase_if(rivals, [&](std::size_t i) {
        return lines[i].empty() || !compare::may_win(r.cells, i, r.controls);
    });
    for (const Rows& rows : store::alike(r.cells, rivals, {"problem"}))
        for (const std::string& error : errors_in(r.cells))
            for (const char* cost :
                 {"cost_s_per_s", "ns_per_step", "worst_block_of_deadline", "rate", "dofs"}) {
                const auto front = compare::pareto_front(r.cells, rows, error, cost);
                for (std::size_t k = 0; k < front.size(); ++k)
                    if (front[k])
                        t.rows.push_back(
                            {r.cells.at(rows[k], "problem"), std::to_string(rows[k]), error, cost});
            }
    return t;
}

// a tie with the truth has no order, and an error that is all wrong is not on its way to one
Table orders_of(const Table& cells) {
    Table t{{"problem", "series", "error", "order", "half_width", "points"}, {}};
    Rows ended = store::all_rows(cells);
    std::erase_if(ended, [&](std::size_t i) {
        return cells.at(i, "status") != "ok" || !(cells.number(i, "rate") > 0);
    });
    const auto names = errors_in(cells);
    for (const Rows& rows : store::alike(cells, ended, {"problem", "series"}))
        for (const std::string& error : names) {
            if (const Order o = compare::fall_over_rates(cells, rows, error).order; o.points >= 2)
                t.rows.push_back({cells.at(rows[0], "problem"), cells.at(rows[0], "series"), error,
                                  store::text_of(o.order), store::text_of(o.half_width),
                                  std::to_string(o.points)});
        }
    return t;
}
}  // namespace

std::map<std::string, store::Table> derived_tables(const Results& r) {
    const auto lines = lines_of(r.cells);
    std::map<std::string, Table> all{{"judged", judged_of(r, lines)},
                                     {"bounds", bounds_of(r.cells)},
                                     {"fronts", fronts_of(r, lines)},
                                     {"orders", orders_of(r.cells)}};
    for (const Rows& rows : store::alike(r.cells, store::all_rows(r.cells), {"problem"})) {
        const std::string& problem = r.cells.at(rows[0], "problem");
        const Table own = rows_where(r.cells, "problem", problem);
        append(all["scenes"], scene_of(own, problem));
        append(all["cheapest"], cheapest_in(r, own, problem));
    }
    return all;
}

}  // namespace jvari::bench::report
