#include "bench/compare/record/cheapest.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

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
constexpr Target targets[] = {{true, 0.1}, {true, 0.01}, {true, 0.001}, {false, 3}, {false, 1}};
struct Goal {
    std::string measure;
    double most;
    bool met(const store::Table& cells, std::size_t i) const { return bound_of(cells, i, measure).most() <= most; }
    bool undecided(const store::Table& cells, std::size_t i) const { return !met(cells, i) && bound_of(cells, i, measure).least() <= most; }
};

// The other schemes of those rows, each once, in the order of the rows, by the row of least cost of each.
template <class Which>
store::Rows other_schemes(const store::Table& cells, const store::Rows& rows, const std::string& best, Which which) {
    store::Rows others;
    for (const std::size_t i : rows) {
        if (cells.at(i, "scheme") == best || !which(i)) continue;
        const auto known =
            std::find_if(others.begin(), others.end(), [&](std::size_t k) { return cells.at(k, "scheme") == cells.at(i, "scheme"); });
        if (known == others.end()) others.push_back(i);
        else if (cells.number(i, "cost_s_per_s") < cells.number(*known, "cost_s_per_s")) *known = i;
    }
    return others;
}

std::string joined(const store::Table& cells, const store::Rows& rows, const char* column) {
    std::string text;
    for (const std::size_t i : rows) {
        const std::string& word = cells.at(i, column);
        text += (text.empty() ? "" : " ") + (word.empty() ? "-" : word);  // a scheme without a sample rate keeps its place
    }
    return text;
}

// From `status` on.
std::vector<std::string> fields_of(const store::Table& cells, const store::Rows& rows, const Goal& goal) {
    std::optional<std::size_t> best;
    for (const std::size_t i : rows)
        if (goal.met(cells, i) && (!best || cells.number(i, "cost_s_per_s") < cells.number(*best, "cost_s_per_s"))) best = i;
    const auto undecided = [&](std::size_t i) { return goal.undecided(cells, i); };
    if (!best) {
        const bool open = std::any_of(rows.begin(), rows.end(), undecided);
        const bool waveform = goal.measure != "third_octave_db";
        return {open ? "not_known" : "none",
                "",
                "",
                "",
                "",
                "",
                "",
                "",
                "",
                "",
                open ? joined(cells, other_schemes(cells, rows, "", undecided), "scheme") : "",
                waveform && !open ? why_none(cells, rows, goal.measure, goal.most) : ""};
    }
    const std::string& scheme = cells.at(*best, "scheme");
    const Bound b = bound_of(cells, *best, goal.measure);
    const store::Rows ties = other_schemes(cells, rows, scheme, [&](std::size_t i) {
        return goal.met(cells, i) && cells.number(i, "cost_lower") <= cells.number(*best, "cost_upper");
    });
    const store::Rows perhaps = other_schemes(cells, rows, scheme, [&](std::size_t i) {
        return undecided(i) && cells.number(i, "cost_s_per_s") < cells.number(*best, "cost_s_per_s");
    });
    return {"found",
            scheme,
            cells.at(*best, "options"),
            cells.at(*best, "rate"),
            cells.at(*best, "modes"),
            store::text_of(b.error),
            std::isnan(b.certificate) ? "" : store::text_of(b.most()),
            cells.at(*best, "cost_s_per_s"),
            joined(cells, ties, "scheme"),
            joined(cells, ties, "rate"),
            joined(cells, perhaps, "scheme"),
            ""};
}
}  // namespace

bool may_win(const store::Table& cells, std::size_t row, Controls controls) {
    const std::string& scheme = cells.at(row, "scheme");
    const auto is_this = [&scheme](const Descriptor& d) { return d.name == scheme && is_control(d); };
    return trusted(cells, row) && (controls == Controls::compete || std::ranges::none_of(schemes(), is_this));
}

store::Table cheapest_of(const store::Table& cells, const std::string& scene, Controls controls) {
    const std::vector<std::string> swept = store::with_machine(cells, store::swept_keys(cells));
    store::Table t;
    t.columns = {"scene"};
    t.columns.insert(t.columns.end(), swept.begin(), swept.end());
    for (const char* name : {"measure", "target", "status", "scheme", "options", "rate", "modes", "error", "bound", "cost_s_per_s", "ties",
                             "tie_rates", "perhaps", "why"})
        t.columns.push_back(name);
    std::vector<std::string> naming = swept;
    naming.insert(naming.begin(), "scene");
    for (const store::Rows& group : store::alike(cells, store::all_rows(cells), naming)) {
        store::Rows rows;
        for (const std::size_t i : group)
            if (may_win(cells, i, controls) && cells.number(i, "cost_s_per_s") > 0) rows.push_back(i);
        if (rows.empty()) continue;  // nothing was timed, or this is the group of those that were not
        std::vector<std::string> key{cells.column("scene") < 0 ? scene : cells.at(rows.front(), "scene")};
        for (const std::string& name : swept) key.push_back(cells.at(rows.front(), name));
        for (const Target& target : targets) {
            const Goal goal{target.waveform ? headline_error(cells, rows) : "third_octave_db", target.most};
            if (std::none_of(rows.begin(), rows.end(), [&](std::size_t i) { return std::isfinite(cells.number(i, goal.measure)); }))
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
    return t.at(row, "measure") == "third_octave_db" ? fmt::format("{:g} dB", most) : fmt::format("{:g} %", 100 * most);
}

std::string ties_text(const store::Table& t, std::size_t row) {
    std::istringstream names(t.at(row, "ties")), rates(t.at(row, "tie_rates"));
    std::string text;
    for (std::string name, rate; names >> name;) {
        rates >> rate;
        const double hz = store::number_of(rate);
        text += (text.empty() ? "" : ", ") + name + (std::isnan(hz) ? "" : fmt::format(" at {:.5g} kHz", hz / 1000));
    }
    return text;
}

std::string cheapest_text(const store::Table& t) {
    std::string text, last;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        std::string scene = t.at(i, "scene");
        for (int k = t.column("scene") + 1; k < t.column("measure"); ++k)
            if (!t.rows[i][k].empty()) scene += " " + t.columns[k] + "=" + t.rows[i][k];
        if (scene != last) text += fmt::format("{}the cheapest scheme on {}\n", text.empty() ? "" : "\n", scene);
        last = scene;
        text += fmt::format("  {:<16} within {:<6}  ", t.at(i, "measure"), goal_name(t, i));
        const std::string& perhaps = t.at(i, "perhaps");
        if (t.at(i, "status") == "not_known") text += "not known: the reference is not certain enough to tell\n";
        else if (t.at(i, "status") == "none") text += t.at(i, "why").empty() ? "none\n" : fmt::format("none\n    {}\n", t.at(i, "why"));
        else {
            const std::string tied = ties_text(t, i);
            text += fmt::format("{} {}, {:.3g} s per s{}{}\n", store::variant_name(t.at(i, "scheme"), t.at(i, "options")),
                                t.at(i, "rate").empty() ? "with " + t.at(i, "modes") + " modes" : "at " + t.at(i, "rate") + " Hz",
                                t.number(i, "cost_s_per_s"), tied.empty() ? "" : "; a tie with " + tied,
                                perhaps.empty() ? "" : "; perhaps for less " + perhaps);
        }
    }
    if (t.column("machine") >= 0) text += "cells were timed on several machines: each has its own cheapest\n";
    if (!text.empty()) text.pop_back();
    return text;
}

}  // namespace jvari::bench::compare
