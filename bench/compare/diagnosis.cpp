#include "bench/compare/diagnosis.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double least_order = 0.5;   // below it a rate that would do is out of reach
constexpr double furthest = 64;       // of an extrapolation, in rates
constexpr double fewest_points = 3;   // two lie on every line
constexpr double of_the_modes = 0.3;  // an error in the model of less than this of the error: the rest is of the modes left out

std::string percent(double x) {
    return fmt::format("{:.2g} %", 100 * x);
}

std::string rate_text(double hertz) {
    return fmt::format("{:.4g} kHz", hertz / 1000);
}

std::string cell_name(const store::Table& cells, std::size_t row) {
    const double rate = cells.number(row, "rate");
    return store::variant_name(cells.at(row, "scheme"), cells.at(row, "options")) + (std::isnan(rate) ? "" : " at " + rate_text(rate));
}

std::optional<std::size_t> least(const store::Table& cells, const store::Rows& rows, const std::string& column) {
    std::optional<std::size_t> best;
    for (const std::size_t i : rows)
        if (const double x = cells.number(i, column); std::isfinite(x) && (!best || x < cells.number(*best, column))) best = i;
    return best;
}

std::optional<std::size_t> cheapest_within(const store::Table& cells, const store::Rows& rows, const std::string& column, double most) {
    std::optional<std::size_t> best;
    for (const std::size_t i : rows)
        if (bound_of(cells, i, column).most() <= most && (!best || cells.number(i, "cost_s_per_s") < cells.number(*best, "cost_s_per_s")))
            best = i;
    return best;
}

// Over the rates of the series that `row` is of, errors that noise and reference allow.
Order order_of(const store::Table& cells, const store::Rows& rows, std::size_t row, const std::string& measure) {
    std::vector<double> rates, errors;
    for (const store::Rows& series : store::differing_in_rate(cells, rows, store::naming_columns(cells))) {
        if (std::ranges::find(series, row) == series.end()) continue;
        for (const std::size_t i : series)
            if (const double e = cells.number(i, measure); e < 1 && bound_of(cells, i, measure).decides() && cells.number(i, "rate") > 0) {
                rates.push_back(cells.number(i, "rate"));
                errors.push_back(e);
            }
    }
    return observed_order(rates, errors);
}

std::string instead(const store::Table& cells, const store::Rows& rows, const std::string& measure, double most) {
    for (const double db : {1.0, 3.0})
        if (const auto i = cheapest_within(cells, rows, "third_octave_db", db))
            return fmt::format("by third octaves {:g} dB is reached by {}", db, cell_name(cells, *i));
    if (measure != "error_l2_10ms")
        if (const auto i = cheapest_within(cells, rows, "error_l2_10ms", most))
            return fmt::format("over 10 ms {} is within", cell_name(cells, *i));
    const auto i = least(cells, rows, "third_octave_db");
    return i ? fmt::format("by third octaves the nearest is {}, {:.2g} dB", cell_name(cells, *i), cells.number(*i, "third_octave_db"))
             : "no other measure is nearer";
}
}  // namespace

std::string why_none(const store::Table& cells, const store::Rows& rows, const std::string& measure, double most) {
    const auto best = least(cells, rows, measure);
    if (!best) return "no run covers the window";
    const Bound b = bound_of(cells, *best, measure);
    std::string text = fmt::format("the nearest is {}, {}", cell_name(cells, *best), percent(b.error));
    const auto and_so = [&text](const std::string& more) { text += "; " + more; };
    if (b.floor > most) and_so(fmt::format("a start 1e-12 apart alone makes {}", percent(b.floor)));
    if (b.certificate > most) and_so(fmt::format("the reference itself is certain to {} only", percent(b.certificate)));

    const Order o = order_of(cells, rows, *best, measure);
    const bool known = o.points >= fewest_points && std::isfinite(o.half_width);
    if (known && o.order - o.half_width > 0 && o.order >= least_order) {
        const double rate = cells.number(*best, "rate") * std::pow(b.error / most, 1 / o.order);
        if (rate <= furthest * cells.number(*best, "rate") && !(b.floor > most)) {
            and_so(fmt::format("errors fall as rate^-{:.2g}, so {} would be enough: extrapolated, not run", o.order, rate_text(rate)));
            return text;
        }
    }
    if (!std::isnan(o.order))
        and_so(fmt::format("errors fall as rate^-{:.2g} only, and no rate within reach will do", std::max(0.0, o.order)));
    std::string in_model = measure;
    if (in_model.starts_with("error_")) in_model.insert(6, "in_model_");
    if (const double e = cells.number(*best, in_model); e < of_the_modes * b.error)
        and_so(fmt::format("{} of it is the scheme's own, the rest is of the modes left out: more of them by --modes", percent(e)));
    if (const double h = cells.number(*best, "horizon_s"); std::isfinite(h)) and_so(fmt::format("waveforms part after {:.2g} ms", 1e3 * h));
    if (std::isfinite(b.floor) && !(b.floor > most)) and_so(fmt::format("noise floor {}", percent(b.floor)));
    and_so(instead(cells, rows, measure, most));
    return text;
}

}  // namespace jvari::bench::compare
