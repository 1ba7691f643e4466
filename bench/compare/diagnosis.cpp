#include "bench/compare/diagnosis.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double least_order = 0.5;  // below it a rate that would do is out of reach
constexpr double hardly = 0.1;       // an order below it is none
constexpr double furthest = 64;      // of an extrapolation, in rates
constexpr double fewest_points = 3;  // two lie on every line
// an error in the model of less than this of the error: the rest is of the modes left out
constexpr double of_the_modes = 0.3;
// of a horizon that is worth a word; the latter [s]
constexpr double before_the_end = 0.98, first_of_all = 1e-3;

std::string rate_text(double hertz) { return fmt::format("{:.4g} kHz", hertz / 1000); }

bool is_grid(const store::Table& cells, std::size_t row) {
    return cells.number(row, "fact_grid_intervals") > 0;
}

std::optional<std::size_t> least(const store::Table& cells, const store::Rows& rows,
                                 const std::string& column) {
    std::optional<std::size_t> best;
    const auto shown = [&](std::size_t i) { return bound_of(cells, i, column).shown(); };
    for (const std::size_t i : rows)
        if (std::isfinite(shown(i)) && (!best || shown(i) < shown(*best))) best = i;
    return best;
}

std::optional<std::size_t> cheapest_within(const store::Table& cells, const store::Rows& rows,
                                           const std::string& column, double most) {
    std::optional<std::size_t> best;
    for (const std::size_t i : rows)
        if (bound_of(cells, i, column).most() <= most &&
            (!best || cells.number(i, "cost_s_per_s") < cells.number(*best, "cost_s_per_s")))
            best = i;
    return best;
}

std::vector<std::string> same_series(const store::Table& cells,
                                     std::initializer_list<const char*> and_more) {
    std::vector<std::string> same = store::naming_columns(cells);
    same.insert(same.end(), and_more.begin(), and_more.end());
    return same;
}
bool alike(const store::Table& cells, std::size_t a, std::size_t b,
           const std::vector<std::string>& columns) {
    return std::ranges::all_of(
        columns, [&](const std::string& name) { return cells.at(a, name) == cells.at(b, name); });
}

// Over all rates of the series that `row` is of, errors that noise and reference allow.
Order order_of(const store::Table& cells, std::size_t row, const std::string& measure) {
    std::vector<std::string> same = same_series(cells, {});
    if (!is_grid(cells, row)) same.emplace_back("modes");
    store::Rows series = store::all_rows(cells);
    std::erase_if(series, [&](std::size_t i) {
        return !cells.at(i, "flags").empty() || !alike(cells, i, row, same);
    });
    return fall_over_rates(cells, series, measure).order;
}

std::string of_the_rate(const Order& o, const store::Table& cells, std::size_t row,
                        const std::string& measure, double most) {
    if (o.points < fewest_points || !std::isfinite(o.half_width))
        return o.points < 2 ? "" : " Two rates are too few to extrapolate: run a third.";
    if (o.order - o.half_width <= 0 && o.order + o.half_width >= least_order)
        return " From these rates it cannot be told whether a higher rate helps.";
    if (o.order < hardly || o.order - o.half_width <= 0)
        return fmt::format(
            " The error hardly falls with the rate (order {:.2f}), so a higher rate will not help.",
            std::max(0.0, o.order));
    const double rate =
        cells.number(row, "rate") * std::pow(cells.number(row, measure) / most, 1 / o.order);
    if (o.order < least_order || rate > furthest * cells.number(row, "rate"))
        return fmt::format(
            " The error falls with the rate (order {:.2g}), but no rate within reach is enough.",
            o.order);
    return fmt::format(
        " The error falls with the rate (order {:.2g}): {} would be enough, extrapolated and not "
        "run.",
        o.order, rate_text(rate));
}

std::string in_model(std::string measure) {
    return measure.starts_with("error_") ? measure.insert(6, "in_model_") : measure;
}

std::string of_the_modes_left_out(const store::Table& cells, std::size_t row,
                                  const std::string& measure) {
    const double modes = cells.number(row, "modes"), error = cells.number(row, measure);
    if (is_grid(cells, row) || !(modes > 0)) return "";
    if (cells.number(row, in_model(measure)) < of_the_modes * error)
        return fmt::format(" Most of that comes from the modes left out: try `--modes {:.0f}`.",
                           2 * modes);
    const std::vector<std::string> same = same_series(cells, {"rate"});
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {  // fewer, at its rate
        const double fewer = cells.number(i, "modes"),
                     order = std::log(cells.number(i, measure) / error) / std::log(modes / fewer);
        if (fewer < modes && reached(cells, i) && order >= least_order &&
            alike(cells, i, row, same))
            return fmt::format(" The error falls with the modes: try `--modes {:.0f}`.", 2 * modes);
    }
    return "";
}

// Where no string with as many modes was run that would tell whether they stand in the way.
std::string of_more_modes(const store::Table& cells, std::size_t row, const std::string& measure) {
    const double modes = cells.number(row, "modes"), most = cells.number(row, "reference_modes");
    if (is_grid(cells, row) || std::isfinite(cells.number(row, in_model(measure))) ||
        !(modes > 0 && modes < most))
        return "";
    return fmt::format(" More modes may help: try `--modes {:.0f}`.", std::min(2 * modes, most));
}

std::string of_the_compliance(const store::Table& cells, const store::Rows& rows, std::size_t row) {
    const auto matched = [&](std::size_t i) {
        return cells.at(i, "options").find("compliance=matched") != std::string::npos;
    };
    const auto has_both = [&](const Descriptor& d) {
        return d.name == cells.at(row, "scheme") && declares(d, compliance_option.name);
    };
    const bool touched = cells.number(row, facts::deepest_penetration.name) > 0;
    const bool measured =
        cells.column("reference_doubling") >= 0 &&
        cells.at(row, "reference_doubling").find("not in your table") != std::string::npos;
    if (!touched || measured || std::ranges::any_of(rows, matched) ||
        std::ranges::none_of(schemes(), has_both))
        return "";
    return " compliance=matched was not run.";
}

std::string instead(const store::Table& cells, const store::Rows& rows, const std::string& measure,
                    double most) {
    for (const double db : {1.0, 3.0})
        if (const auto i = cheapest_within(cells, rows, "third_octave_db", db))
            return fmt::format(" By third octaves {:g} dB is reached by {}.", db,
                               store::run_name(cells, *i));
    if (measure != "error_l2_10ms")
        if (const auto i = cheapest_within(cells, rows, "error_l2_10ms", most))
            return fmt::format(" Over the first 10 ms{} {} is within {}.", after_pluck(cells, *i),
                               store::run_name(cells, *i), percent(most));
    const auto i = least(cells, rows, "third_octave_db");
    return i ? fmt::format(" By third octaves the closest is {}, {:.2g} dB.",
                           store::run_name(cells, *i), cells.number(*i, "third_octave_db"))
             : "";
}
}  // namespace

std::string percent(double share) {
    return share >= 0.0995 ? fmt::format("{:.0f} %", 100 * share)
                           : fmt::format("{:.2g} %", 100 * share);
}

std::string quoted(const Bound& b, const std::string& measure) {
    const bool bounded = b.says() == Bound::Says::at_most || b.says() == Bound::Says::unknown;
    const std::string text = measure.starts_with("third_octave_db")
                                 ? fmt::format("{:.2g} dB", b.shown())
                                 : percent(b.shown());
    return (bounded ? "\u2264 " : "") + text;
}

std::string time_text(double seconds) {
    return seconds >= 0.995 ? fmt::format("{:.2g} s", seconds)
                            : fmt::format("{:.3g} ms", 1e3 * seconds);
}

std::string why_none(const store::Table& cells, const store::Rows& rows, const std::string& measure,
                     double most) {
    const auto best = least(cells, rows, measure);
    if (!best) return "No run covers the window.";
    const Bound b = bound_of(cells, *best, measure);
    std::string text =
        fmt::format("Closest: {}, {} error.", store::run_name(cells, *best), quoted(b, measure));
    if (b.floor > most) {
        text += fmt::format(" A change of the start by 1e-12 alone makes {}.", percent(b.floor));
    } else if (b.certificate > most) {
        text += fmt::format(" The reference is known to {} only.", percent(b.certificate));
    } else {
        const std::string modes = of_the_modes_left_out(cells, *best, measure);
        const Order o = order_of(cells, *best, measure);
        const bool falls = o.order - o.half_width > 0;
        text += modes.empty() ? of_the_rate(o, cells, *best, measure, most) +
                                    (falls ? "" : of_more_modes(cells, *best, measure))
                              : modes;
        text += of_the_compliance(cells, rows, *best);
    }
    const double h = cells.number(*best, "horizon_s"), from = cells.number(*best, "free_from_s"),
                 end = cells.number(*best, "wall_seconds") / cells.number(*best, "cost_s_per_s") -
                       (from > 0 ? from : 0);
    if (h > first_of_all && h < before_the_end * end)
        text += fmt::format(" Its waveform is within 10 % for {}.", time_text(h));
    return text + instead(cells, rows, measure, most);
}

}  // namespace jvari::bench::compare
