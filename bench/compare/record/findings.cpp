#include "bench/compare/record/findings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "analysis/statistics.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/scene_notes.hpp"
#include "reference/references.hpp"
#include "schemes/contact/compliance.hpp"

namespace jvari::bench::compare {

// ---- The front

namespace {
bool sound(const Point& p) { return std::isfinite(p.cost) && std::isfinite(p.error); }
bool tie(const Point& a, const Point& b) {
    return a.cost_lower <= b.cost_upper && b.cost_lower <= a.cost_upper;
}
bool beats(const Point& a, const Point& b) {
    if (!sound(a)) return false;
    if (a.error + a.certificate < b.error - b.certificate) return a.cost <= b.cost || tie(a, b);
    return a.error <= b.error && a.cost < b.cost && !tie(a, b);
}

Point point_of(const study::TabledCell& cell, std::size_t measure) {
    const Bound b = bound_of(cell, measure);
    const bool known = trusted(cell) && b.says() != Bound::Says::unknown;
    return {known ? cell.cost_s_per_s : nan, cell.cost_lower, cell.cost_upper,
            std::isnan(b.error) ? nan : std::fmax(b.error, std::fmax(b.floor, b.certificate)),
            std::isnan(b.certificate) ? 0 : b.certificate};
}
}  // namespace

std::vector<bool> pareto_front(std::span<const Point> points) {
    std::vector<bool> front;
    for (const Point& p : points)
        front.push_back(sound(p) &&
                        std::none_of(points.begin(), points.end(),
                                     [&p](const Point& other) { return beats(other, p); }));
    return front;
}

study::Cells with_front(study::Cells cells) {
    for (const study::Rows& rows : study::by_problem(cells, study::all_rows(cells))) {
        const std::size_t error = headline_error(cells, rows);
        std::vector<Point> points;
        for (const std::size_t row : rows) points.push_back(point_of(cells[row], error));
        const std::vector<bool> front = pareto_front(points);
        for (std::size_t k = 0; k < rows.size(); ++k) cells[rows[k]].pareto = front[k];
    }
    return cells;
}

// ---- Orders

namespace {
using study::Cells, study::Rows;

// Groups that differ only in rate; if a rate comes twice, the modes separate the groups.
std::vector<Rows> differing_in_rate(const Cells& cells) {
    std::vector<Rows> all;
    for (const Rows& group : study::alike(study::all_rows(cells), [&](std::size_t i) {
             return cells[i].problem() + "|" + cells[i].variant();
         })) {
        const auto modes = [&](std::size_t i) { return store::Field(cells[i].modes); };
        const auto rate = [&](std::size_t i) { return store::Field(cells[i].rate); };
        if (study::alike(group, rate).size() == group.size()) all.push_back(group);
        else std::ranges::move(study::alike(group, modes), std::back_inserter(all));
    }
    return all;
}
}  // namespace

std::vector<ObservedOrder> convergence_of(const Cells& cells) {
    std::vector<ObservedOrder> all;
    std::vector<std::string> taps;
    for (const study::TabledCell& c : cells)
        for (const std::string& tap : c.taps)
            if (std::ranges::find(taps, tap) == taps.end()) taps.push_back(tap);
    for (const Rows& rows : differing_in_rate(cells))
        for (const std::string& tap : taps)
            for (std::size_t m = 0; m < study::measures().size(); ++m) {
                if (!study::is_waveform(m)) continue;
                const Fall fall = fall_over_rates(cells, rows, m, tap);
                if (std::isnan(fall.order.order)) continue;
                ObservedOrder o{rows.front(), m,        tap, cells[fall.rows.front()].modes,
                                fall.order,   HUGE_VAL, 0};
                for (const std::size_t i : fall.rows) {
                    if (cells[i].modes != o.modes) o.modes = nan;
                    o.from_hz = std::min(o.from_hz, cells[i].rate);
                    o.to_hz = std::max(o.to_hz, cells[i].rate);
                }
                all.push_back(std::move(o));
            }
    return all;
}

std::vector<Rising> rising_with_the_rate(const Cells& cells) {
    constexpr double rise = 1.2, audible = 1;  // [dB]
    std::vector<Rising> all;
    const std::size_t window = headline_error(cells, study::all_rows(cells)),
                      octaves = study::measure("third_octave_db");
    for (Rows rows : differing_in_rate(cells)) {
        std::erase_if(rows, [&](std::size_t i) {
            return !reached(cells[i]) || !(bound_of(cells[i], window).error >= 0);
        });
        if (rows.size() < 2) continue;
        const auto [low, high] =
            std::ranges::minmax(rows, {}, [&](std::size_t i) { return cells[i].rate; });
        const Bound from = bound_of(cells[low], window), to = bound_of(cells[high], window);
        if (to.least() > rise * from.most())
            all.push_back({low, high,
                           fmt::format("its error rises with the rate, from {} at {:g} Hz to {}",
                                       percent(from.error), cells[low].rate, percent(to.error))});
        const double near = cells[low].figure(octaves).value,
                     far = cells[high].figure(octaves).value;
        if (rise * to.most() < from.least() && far > rise * near && far > near + audible)
            all.push_back({low, high,
                           fmt::format("its third octaves move away from the reference's with the "
                                       "rate, from {:.2g} dB at {:g} Hz to {:.2g} dB, while its "
                                       "waveform comes nearer",
                                       near, cells[low].rate, far)});
    }
    return all;
}

store::Table convergence_table(const Cells& cells) {
    const store::Table named = study::table_of(cells, study::Contents::cost);
    const auto rate = static_cast<std::size_t>(named.column("rate"));
    store::Table t{{named.columns.begin() + 1, named.columns.begin() + rate}, {}};
    t.columns.insert(t.columns.end(), {"modes", "tap", "window", "order", "half_width", "points",
                                       "from_hz", "to_hz"});
    for (const auto& [first, m, tap, modes, order, from, to] : convergence_of(cells)) {
        auto& row =
            t.rows.emplace_back(named.rows[first].begin() + 1, named.rows[first].begin() + rate);
        row.insert(row.end(), {modes, tap, study::measures()[m].column.substr(9), order.order,
                               std::isfinite(order.half_width) ? order.half_width : nan,
                               order.points, from, to});
    }
    return t;
}

// ---- Warnings

namespace {
constexpr double calm = 0.2;
constexpr double harmed = 1.2;  // times the error with own compliance
}  // namespace

double median_spread(const study::Cells& cells) {
    std::vector<double> spreads;
    for (const study::TabledCell& c : cells) {
        const double spread = 0.5 * (c.cost_upper - c.cost_lower) / c.cost_s_per_s;
        if (std::isfinite(spread)) spreads.push_back(spread);
    }
    return spreads.empty() ? nan : spread_of(spreads).median;
}

std::string busy_text(const study::Cells& cells) {
    const double spread = median_spread(cells);
    if (!(spread > calm)) return "";
    return fmt::format(
        "the machine was busy: half of the costs scatter by {:.0f} % and more between their "
        "quartiles; read them as orders of magnitude",
        100 * spread);
}

std::string harm_text(const study::Cells& cells) {
    const std::size_t window = headline_error(cells, study::all_rows(cells));
    const auto but_options = [&](std::size_t i) {
        const study::TabledCell& c = cells[i];
        return fmt::format("{}|{}|{}|{}", c.problem(), c.scheme, c.rate, c.modes);
    };
    int pairs = 0, worse = 0;
    double most = 0;
    std::string worst;
    for (const study::Rows& alike : study::alike(study::all_rows(cells), but_options))
        for (const std::size_t i : alike)
            for (const std::size_t j : alike) {
                if (!is_matched(cells[i].options) || !trusted(cells[i]) || !trusted(cells[j]))
                    continue;
                store::Options own = cells[i].options;
                for (auto& [name, value] : own)
                    if (name == compliance_option.name) value = "own";
                if (own != cells[j].options) continue;
                ++pairs;
                bool any = false;
                for (const std::string& tap : cells[i].taps) {
                    const Bound is = bound_of(cells[i], window, tap),
                                was = bound_of(cells[j], window, tap);
                    if (!(is.least() > harmed * was.most())) continue;
                    any = true;
                    if (is.error / was.error <= most) continue;
                    most = is.error / was.error;
                    worst = fmt::format("{} of {} by {}", tap, percent(is.error), cells[i].run());
                    worst += fmt::format(", where own compliance has {}", percent(was.error));
                }
                worse += any;
            }
    if (worse == 0) return "";
    return fmt::format(
        "in {} of {} runs matched compliance errs more than 1.2 times as much as own at a tap, "
        "most at {}. Own errors of modes "
        "and step may cancel: twice the rate, or the modes, tells (docs/compliance-matching.md)",
        worse, pairs, worst);
}

std::string cause_text(const study::Cells& cells) {
    std::string text;
    for (const Rising& r : rising_with_the_rate(cells))
        text += fmt::format("; {}: {}", cells[r.high].run(), r.text);
    for (const Rows& rows : differing_in_rate(cells)) {
        const std::size_t high = std::ranges::max(
            rows, {}, [&](std::size_t i) { return std::isnan(cells[i].rate) ? 0 : cells[i].rate; });
        if (!cells[high].cause.empty())
            text += fmt::format("; {}: {}", cells[high].run(), cells[high].cause);
    }
    return text.empty() ? "" : "most of an error has one cause: " + text.substr(2);
}

Verdict verdict_on(const Advice& a, const study::Cells& cells) {
    Verdict v;
    if (!a.scheme) return {.text = "nothing was advised"};
    for (std::size_t i = 0; i < cells.size() && !v.cell; ++i)
        if (const study::TabledCell& c = cells[i];
            c.scheme == a.scheme->name && c.options == a.settings.options &&
            c.modes == a.settings.modes && c.rate == a.settings.sample_rate)
            v.cell = i;
    if (v.cell) v.bound = bound_of(cells[*v.cell], a.target.measure, a.tap);
    const Target& t = a.target;
    const bool waveform = study::is_waveform(t.measure);
    const double most = waveform ? v.bound.most() : v.bound.error,
                 least = waveform ? v.bound.least() : v.bound.error;
    const std::string condition = fmt::format("{}, where {} {}", t.text(v.bound.error),
                                              a.within ? "at most" : "the nearest to",
                                              t.text(t.most) + (a.within ? " was promised" : ""));
    if (!std::isfinite(v.bound.error)) {
        v.text = "the advice was not verified: the cell has no such error";
    } else if (most <= t.most) {
        v.says = Verdict::Says::confirmed;
        v.text = "the advice held: an error of " + condition;
    } else if (least > t.most) {
        v.says = a.within ? Verdict::Says::refuted : Verdict::Says::confirmed;
        v.text = fmt::format("the advice {}: an error of {}", a.within ? "did not hold" : "held",
                             condition);
    } else {
        v.text = fmt::format(
            "whether the advice holds is not known: an error of {}, and the "
            "reference is known to {}",
            condition, t.text(v.bound.certificate, "no figure"));
    }
    return v;
}

std::vector<std::string> warnings_of(const study::Cells& cells) {
    std::vector<std::string> all{busy_text(cells), harm_text(cells), cause_text(cells)};
    std::erase(all, "");
    return all;
}

}  // namespace jvari::bench::compare
