#include "bench/compare/record/cheapest.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/cheapest.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/diagnosis.hpp"
#include "bench/store/cell_rows.hpp"
#include "schemes/controls.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::compare {

namespace {
struct Target {
    bool waveform;
    double most;
};
std::vector<Target> targets() {
    std::vector<Target> all;
    for (const double most : accuracies) all.push_back({true, most});
    for (const double decibels : {3.0, 1.0}) all.push_back({false, decibels});
    return all;
}
struct Goal {
    std::string measure;
    double most;
    bool met(const store::Table& cells, std::size_t i) const {
        return bound_of(cells, i, measure).most() <= most;
    }
};

std::string named(const store::Table& cells, const store::Rows& rows,
                  const std::vector<std::size_t>& chosen) {
    std::string text;
    for (const std::size_t k : chosen)
        text += (text.empty() ? "" : "; ") + store::run_name(cells, rows[k]);
    return text;
}

Choice choice_of(const store::Table& cells, const store::Rows& rows, const Goal& goal) {
    std::vector<Offer> offers;
    for (const std::size_t i : rows) {
        const Bound b = bound_of(cells, i, goal.measure);
        offers.push_back({cells.at(i, "scheme"), b.most(), b.least(),
                          cells.number(i, "cost_s_per_s"), cells.number(i, "cost_lower"),
                          cells.number(i, "cost_upper")});
    }
    return cheapest_within(goal.most, offers);
}

std::optional<std::size_t> least_cost(const store::Table& cells, const store::Rows& rows,
                                      const auto& which) {
    std::optional<std::size_t> best;
    for (const std::size_t i : rows)
        if (which(i) &&
            (!best || cells.number(i, "cost_s_per_s") < cells.number(*best, "cost_s_per_s")))
            best = i;
    return best;
}

// Of the scene's other taps those by which a cell is surely within it: "; by y02: ..., 0.16 %"
std::string by_other_taps(const store::Table& cells, const store::Rows& rows, const Goal& goal) {
    std::string text;
    for (const std::string& column : cells.columns) {
        if (!column.starts_with(goal.measure + "_")) continue;
        const Goal same{column, goal.most};
        if (const auto i =
                least_cost(cells, rows, [&](std::size_t k) { return same.met(cells, k); }))
            text += fmt::format("{} by {}: {}, {}", text.empty() ? ";" : ",",
                                column.substr(goal.measure.size() + 1), store::run_name(cells, *i),
                                quoted(bound_of(cells, *i, column), column));
    }
    return text;
}

// Why it cannot be decided who is within `goal`.
std::string why_unknown(const store::Table& cells, const store::Rows& rows, const Goal& goal) {
    const double certificate = bound_of(cells, rows.front(), goal.measure).certificate;
    if (!std::isnan(certificate))
        return fmt::format("the reference is known to {} only{}", percent(certificate),
                           by_other_taps(cells, rows, goal));
    const auto seems = least_cost(
        cells, rows, [&](std::size_t i) { return cells.number(i, goal.measure) <= goal.most; });
    return "the uncertainty of the reference is unknown" +
           (seems ? fmt::format("; measured against it, the cheapest is {}, {}",
                                store::run_name(cells, *seems),
                                percent(cells.number(*seems, goal.measure)))
                  : std::string());
}

bool is_matched(const store::Table& cells, std::size_t row) {
    return cells.at(row, "options").find("compliance=matched") != std::string::npos;
}

bool is_unsure(const store::Table& cells, const store::Rows& rows) {  // whatever the measure
    return std::isnan(bound_of(cells, rows.front(), headline_error(cells, rows)).certificate);
}

std::string published_text(const store::Table& cells, std::optional<std::size_t> row,
                           const Goal& goal) {
    if (!row) return "none";
    return fmt::format("{}, {}, {:.3g} s per s", store::run_name(cells, *row),
                       quoted(bound_of(cells, *row, goal.measure), goal.measure),
                       cells.number(*row, "cost_s_per_s"));
}

// From `status` on.
std::vector<std::string> fields_of(const store::Table& cells, const store::Rows& rows,
                                   const Goal& goal) {
    const Choice choice = choice_of(cells, rows, goal);
    if (!choice.best) {
        const bool open = !choice.perhaps.empty();
        const bool waveform = goal.measure != "third_octave_db";
        std::vector<std::string> fields{open ? "not_known" : "none"};
        fields.resize(10);  // nothing to say of the cell
        const bool bounded =
            open && !std::isnan(bound_of(cells, rows.front(), goal.measure).certificate);
        fields.push_back(bounded ? named(cells, rows, choice.perhaps) : "");
        fields.emplace_back();
        fields.push_back(open       ? why_unknown(cells, rows, goal)
                         : waveform ? why_none(cells, rows, goal.measure, goal.most)
                                    : "");
        return fields;
    }
    const std::size_t best = rows[*choice.best];
    const Bound b = bound_of(cells, best, goal.measure);
    const auto published = [&](std::size_t i) {
        return goal.met(cells, i) && !is_matched(cells, i);
    };
    return {
        "found",
        store::run_name(cells, best),
        cells.at(best, "scheme"),
        cells.at(best, "options"),
        cells.at(best, "rate"),
        cells.at(best, "modes"),
        store::text_of(b.error),
        store::text_of(b.most()),
        cells.at(best, "cost_s_per_s"),
        named(cells, rows, choice.ties),
        named(cells, rows, choice.perhaps),
        is_matched(cells, best) ? published_text(cells, least_cost(cells, rows, published), goal)
                                : "",
        is_unsure(cells, rows) ? "measured against a reference whose uncertainty is unknown" : ""};
}
}  // namespace

bool may_win(const store::Table& cells, std::size_t row, Controls controls) {
    const std::string& scheme = cells.at(row, "scheme");
    const auto is_this = [&scheme](const Descriptor& d) {
        return d.name == scheme && is_control(d);
    };
    return trusted(cells, row) &&
           (controls == Controls::compete || std::ranges::none_of(schemes(), is_this));
}

store::Table cheapest_of(const store::Table& cells, Controls controls) {
    const std::vector<std::string> swept = store::swept_keys(cells);
    store::Table t;
    t.columns = {"scene"};
    t.columns.insert(t.columns.end(), swept.begin(), swept.end());
    for (const char* name :
         {"measure", "target", "status", "run", "scheme", "options", "rate", "modes", "error",
          "bound", "cost_s_per_s", "ties", "perhaps", "as_published", "why"})
        t.columns.push_back(name);
    std::vector<std::string> naming = swept;
    naming.insert(naming.begin(), "scene");
    for (const store::Rows& group : store::alike(cells, store::all_rows(cells), naming)) {
        store::Rows rows;
        for (const std::size_t i : group)
            if (may_win(cells, i, controls) && cells.number(i, "cost_s_per_s") > 0)
                rows.push_back(i);
        // nothing was timed, or this is the group of those that were not
        if (rows.empty()) continue;
        std::vector<std::string> key{cells.at(rows.front(), "scene")};
        for (const std::string& name : swept) key.push_back(cells.at(rows.front(), name));
        for (const Target& target : targets()) {
            const Goal goal{target.waveform ? headline_error(cells, rows) : "third_octave_db",
                            target.most};
            if (std::none_of(rows.begin(), rows.end(), [&](std::size_t i) {
                    return std::isfinite(cells.number(i, goal.measure));
                }))
                continue;  // the run is too short for it
            auto& row = t.rows.emplace_back(key);
            row.push_back(goal.measure);
            row.push_back(store::text_of(goal.most));
            for (const std::string& field : fields_of(cells, rows, goal)) row.push_back(field);
        }
    }
    return t;
}

std::string goal_name(const store::Table& t, std::size_t row) {
    const double most = t.number(row, "target");
    return t.at(row, "measure") == "third_octave_db" ? fmt::format("{:g} dB", most)
                                                     : fmt::format("{:g} %", 100 * most);
}

std::string cheapest_text(const store::Table& t) {
    std::string text, last;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        std::string scene = t.at(i, "scene");
        for (int k = t.column("scene") + 1; k < t.column("measure"); ++k)
            if (!t.rows[i][k].empty()) scene += " " + t.columns[k] + "=" + t.rows[i][k];
        if (scene != last)
            text += fmt::format("{}the cheapest scheme on {}\n", text.empty() ? "" : "\n", scene);
        last = scene;
        text += fmt::format("  {:<16} within {:<6}  ", t.at(i, "measure"), goal_name(t, i));
        const std::string &status = t.at(i, "status"), &why = t.at(i, "why"),
                          &perhaps = t.at(i, "perhaps"), &ties = t.at(i, "ties");
        if (status == "not_known") {
            text += fmt::format("cannot be decided: {}\n", why);
            if (!perhaps.empty()) text += fmt::format("    candidates: {}\n", perhaps);
        } else if (status == "none") {
            text += why.empty() ? "none\n" : fmt::format("none. {}\n", why);
        } else {
            const Bound b{t.number(i, "error"), t.number(i, "bound") - t.number(i, "error")};
            text += fmt::format("{}, {}, {:.3g} s per s{}{}\n", t.at(i, "run"),
                                quoted(b, t.at(i, "measure")), t.number(i, "cost_s_per_s"),
                                ties.empty() ? "" : "; a tie with " + ties,
                                perhaps.empty() ? "" : "; perhaps for less " + perhaps);
            if (!why.empty()) text += fmt::format("    {}\n", why);
            if (const std::string& published = t.at(i, "as_published"); !published.empty())
                text += fmt::format("    without matched compliance: {}\n", published);
        }
    }
    if (!text.empty()) text.pop_back();
    return text;
}

}  // namespace jvari::bench::compare
