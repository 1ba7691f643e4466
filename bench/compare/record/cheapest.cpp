#include "bench/compare/record/cheapest.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bench/compare/scene_notes.hpp"
#include "reference/references.hpp"
#include "schemes/controls.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::compare {

namespace {
using Cell = study::TabledCell;
using study::Cells, study::Rows;

struct Goal {
    std::size_t measure;
    double most;
    bool met(const Cell& c, const std::string& tap = "") const {
        return bound_of(c, measure, tap).most() <= most;
    }
};

std::string named(const Cells& cells, const Rows& rows, const std::vector<std::size_t>& chosen) {
    std::string text;
    for (const std::size_t k : chosen) text += (text.empty() ? "" : "; ") + cells[rows[k]].run();
    return text;
}

std::vector<Offer> offers_of(const Cells& cells, const Rows& rows, std::size_t measure,
                             const std::string& tap = "") {
    std::vector<Offer> offers;
    for (const std::size_t i : rows) {
        const Bound b = bound_of(cells[i], measure, tap);
        offers.push_back({cells[i].scheme, b.most(), b.least(), cells[i].cost_s_per_s,
                          cells[i].cost_lower, cells[i].cost_upper});
    }
    return offers;
}

const Cell* least_cost(const Cells& cells, const Rows& rows, const auto& which) {
    const Cell* best = nullptr;
    for (const std::size_t i : rows)
        if (which(cells[i]) && (!best || cells[i].cost_s_per_s < best->cost_s_per_s))
            best = &cells[i];
    return best;
}

// Other taps at which a cell is surely within the goal: "; by y02: ..., 0.16 %".
std::string by_other_taps(const Cells& cells, const Rows& rows, const Goal& goal) {
    std::string text;
    for (const std::string& tap : cells[rows.front()].taps)
        if (const Cell* c =
                least_cost(cells, rows, [&](const Cell& k) { return goal.met(k, tap); }))
            text += fmt::format("{} by {}: {}, {}", text.empty() ? ";" : ",", tap, c->run(),
                                quoted(bound_of(*c, goal.measure, tap), goal.measure));
    return text;
}

double certificate_of(const Cells& cells, const Rows& rows, std::size_t measure) {
    return bound_of(cells[rows.front()], measure).certificate;
}

// Longest shorter window over which the reference is known within `goal`: "; over the first 10 ms
// to 0.4 %". The windows of measures() ascend.
std::string decided_over(const Cells& cells, const Rows& rows, const Goal& goal) {
    for (std::size_t m = goal.measure; m-- > 0;)
        if (const double known = certificate_of(cells, rows, m); known <= goal.most)
            return fmt::format("; over the first {}{} to {}",
                               time_text(study::measures()[m].window),
                               after_pluck(cells[rows.front()]), percent(known));
    return "";
}

// Reason why nobody can decide which cells are within `goal`.
std::string why_unknown(const Cells& cells, const Rows& rows, const Goal& goal) {
    const double certificate = certificate_of(cells, rows, goal.measure);
    if (!std::isnan(certificate))
        return fmt::format("the reference is known to {} only{}{}", percent(certificate),
                           decided_over(cells, rows, goal), by_other_taps(cells, rows, goal));
    const auto error = [&](const Cell& c) { return c.figure(goal.measure).value; };
    const Cell* seems =
        least_cost(cells, rows, [&](const Cell& c) { return error(c) <= goal.most; });
    return "the uncertainty of the reference is unknown" + decided_over(cells, rows, goal) +
           (seems ? fmt::format("; measured against it, the cheapest is {}, {}", seems->run(),
                                percent(error(*seems)))
                  : std::string());
}

std::string published_text(const Cell* c, const Goal& goal) {
    if (!c) return "none";
    return fmt::format("{}, {}, {:.3g} s per s", c->run(),
                       quoted(bound_of(*c, goal.measure), goal.measure), c->cost_s_per_s);
}

Answer answer_of(const Cells& cells, const Rows& rows, const Goal& goal) {
    const Choice choice = cheapest_within(goal.most, offers_of(cells, rows, goal.measure));
    Answer a{rows.front(), goal.measure, goal.most, "found", std::nullopt};
    if (!choice.best) {
        const bool open = !choice.perhaps.empty();
        a.status = open ? "not_known" : "none";
        if (open && !std::isnan(certificate_of(cells, rows, goal.measure)))
            a.perhaps = named(cells, rows, choice.perhaps);
        a.why = open                               ? why_unknown(cells, rows, goal)
                : study::is_waveform(goal.measure) ? why_none(cells, rows, goal.measure, goal.most)
                                                   : "";
        return a;
    }
    a.cell = rows[*choice.best];
    const Cell& best = cells[*a.cell];
    a.bound = bound_of(best, goal.measure);
    a.ties = named(cells, rows, choice.ties);
    a.perhaps = named(cells, rows, choice.perhaps);
    const auto published = [&](const Cell& c) { return goal.met(c) && !is_matched(c.options); };
    if (is_matched(best.options))
        a.as_published = published_text(least_cost(cells, rows, published), goal);
    // for any measure
    if (std::isnan(certificate_of(cells, rows, headline_error(cells, rows))))
        a.why = "measured against a reference whose uncertainty is unknown";
    return a;
}
}  // namespace

bool may_win(const Cell& c, Controls controls) {
    const auto is_this = [&c](const Descriptor& d) { return d.name == c.scheme && is_control(d); };
    return trusted(c) &&
           (controls == Controls::compete || std::ranges::none_of(schemes(), is_this));
}

std::vector<AnswerFrom> answers_along(const Cells& cells, Rows rows, std::size_t measure,
                                      const std::string& tap, Controls controls) {
    std::erase_if(rows, [&](std::size_t i) {
        return !may_win(cells[i], controls) || !(cells[i].cost_s_per_s > 0) ||
               !std::isfinite(cells[i].figure(measure, tap).value);
    });
    const std::vector<Offer> offers = offers_of(cells, rows, measure, tap);
    std::set<double> tolerances;
    for (const Offer& o : offers)
        for (const double bound : {o.least, o.most})
            if (std::isfinite(bound)) tolerances.insert(bound);
    std::vector<AnswerFrom> all;
    for (const double tolerance : tolerances) {
        Choice c = cheapest_within(tolerance, offers);
        if (c.best) c.best = rows[*c.best];
        for (auto* list : {&c.ties, &c.perhaps})
            for (std::size_t& i : *list) i = rows[i];
        if (all.empty() || c != all.back().choice) all.push_back({tolerance, std::move(c)});
    }
    return all;
}

std::vector<Answer> cheapest_of(const Cells& cells, Controls controls) {
    std::vector<Answer> answers;
    const std::size_t octaves = study::measure("third_octave_db");
    for (Rows rows : study::by_problem(cells, study::all_rows(cells))) {
        std::erase_if(rows, [&](std::size_t i) {
            return !may_win(cells[i], controls) || !(cells[i].cost_s_per_s > 0);
        });
        // nothing was timed, or this group holds the untimed cells
        if (rows.empty()) continue;
        std::vector<Goal> goals;
        for (const double most : accuracies) goals.push_back({headline_error(cells, rows), most});
        for (const double decibels : {3.0, 1.0}) goals.push_back({octaves, decibels});
        for (const Goal& goal : goals)
            // true if the run is long enough for the goal
            if (std::ranges::any_of(rows, [&](std::size_t i) {
                    return std::isfinite(cells[i].figure(goal.measure).value);
                }))
                answers.push_back(answer_of(cells, rows, goal));
    }
    return answers;
}

std::string Answer::goal() const {
    return study::is_waveform(measure) ? fmt::format("{:g} %", 100 * most)
                                       : fmt::format("{:g} dB", most);
}

store::Table table_of(const std::vector<Answer>& answers, const Cells& cells) {
    const store::Table names = study::table_of(cells, study::Contents::cost);
    const auto scheme = names.columns.begin() + names.column("scheme");
    store::Table t{{names.columns.begin() + 1, scheme}, {}};
    t.columns.insert(t.columns.end(),
                     {"measure", "target", "status", "run", "scheme", "options", "rate", "modes",
                      "error", "bound", "cost_s_per_s", "ties", "perhaps", "as_published", "why"});
    for (const Answer& a : answers) {
        const Cell found = a.cell ? cells[*a.cell] : Cell{};
        const auto& own = names.rows[a.of];
        auto& row =
            t.rows.emplace_back(own.begin() + 1, own.begin() + (scheme - names.columns.begin()));
        row.insert(row.end(),
                   {study::measures()[a.measure].column, a.most, a.status,
                    a.cell ? found.run() : "", found.scheme, store::options_text(found.options),
                    found.rate, found.modes, a.bound.error, a.bound.most(), found.cost_s_per_s,
                    a.ties, a.perhaps, a.as_published, a.why});
    }
    return t;
}

store::Lines cheapest_lines(const std::vector<Answer>& answers, const Cells& cells) {
    store::Lines lines;
    std::string last;
    for (const Answer& a : answers) {
        std::string scene = cells[a.of].scene;
        for (const auto& [key, value] : cells[a.of].swept) scene += " " + key + "=" + value;
        if (scene != last) {
            if (!lines.empty()) lines.push_back({""});
            lines.push_back({"the cheapest scheme on " + scene, store::Mark::answer});
        }
        last = scene;
        std::string text =
            fmt::format("  {:<16} within {:<6}  ", study::measures()[a.measure].column, a.goal());
        std::string below;
        if (a.cell) {
            text += fmt::format("{}, {}, {:.3g} s per s{}{}", cells[*a.cell].run(),
                                quoted(a.bound, a.measure), cells[*a.cell].cost_s_per_s,
                                a.ties.empty() ? "" : "; a tie with " + a.ties,
                                a.perhaps.empty() ? "" : "; perhaps for less " + a.perhaps);
            below = a.why;
        } else if (std::string(a.status) == "not_known") {
            text += fmt::format("cannot be decided: {}", a.why);
            if (!a.perhaps.empty()) below = "candidates: " + a.perhaps;
        } else {
            text += a.why.empty() ? "none" : "none. " + a.why;
        }
        lines.push_back({text, store::Mark::answer});
        if (!below.empty()) lines.push_back({"    " + below});
        if (a.cell && !a.as_published.empty())
            lines.push_back({"    without matched compliance: " + a.as_published});
    }
    return lines;
}

}  // namespace jvari::bench::compare
