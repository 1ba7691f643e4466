#include "bench/diff/rules.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>

#include "bench/compare/bound.hpp"
#include "bench/study/columns.hpp"
#include "bench/study/errors.hpp"

namespace jvari::bench::diff {

namespace {
constexpr double floors = 1000, rounding = 1e-9, centroid = 1e3;  // [Hz]
constexpr double row = 1.0 / 44100;                               // [s]

template <std::size_t n>
bool begins(const std::string& column, const char* const (&names)[n]) {
    return std::any_of(names, names + n,
                       [&](const char* name) { return column.starts_with(name); });
}

// Facts that follow from closed forms, or count what the settings fix.
bool is_closed_form(const std::string& column) {
    return begins(column,
                  {"fact_static_compliance", "fact_start_phase_offset", "fact_start_phase_error",
                   "fact_period_error_cents", "fact_loss_fit_", "fact_grid_intervals",
                   "fact_interior_nodes", "fact_modes_above_nyquist", "fact_contact_points",
                   "fact_bridge_nodes", "fact_theta", "fact_stable_stiffness_limit"});
}

// The row's own sensitivity: the largest noise floor of its relative L2 errors.
double sensitivity(const store::Table& t, std::size_t i) {
    double largest = 0;
    for (const std::string& column : t.columns)
        if (column.starts_with("floor_error_l2_whole"))
            largest = std::fmax(largest, t.number(i, column));
    return largest;
}

// error_in_model_l2_50ms, third_octave_db_in_model_nut: the error of that name against the scene,
// which has a noise floor.
std::string against_the_scene(std::string column) {
    const std::string part = "_in_model";
    if (const auto at = column.find(part); at != std::string::npos) column.erase(at, part.size());
    return column;
}

// A noise floor counts as the lower of the two: one that was raised in either folder excuses
// nothing.
double tolerance_of(const std::string& column, const store::Table& before, std::size_t i,
                    const store::Table& after, std::size_t k) {
    const double old = std::abs(before.number(i, column));
    const double motion =
        (floors * std::min(sensitivity(before, i), sensitivity(after, k)) + 1e-6) * old;
    const std::string of_scene = against_the_scene(column);
    if (const double floor =
            std::fmin(before.number(i, "floor_" + of_scene), after.number(k, "floor_" + of_scene));
        !std::isnan(floor)) {
        const double noise =
            floors * floor + rounding * (old + (column.starts_with("centroid_hz") ? centroid : 0));
        return of_scene == column ? noise : std::fmax(noise, motion);
    }
    switch (study::rule_of(column)) {
        case study::Rule::floor: return 9 * old + 1e-9;
        case study::Rule::instant: return 2 * row;
        case study::Rule::step: return 2;
        case study::Rule::ledger:
        case study::Rule::force: return 1e-9 + motion;   // [1], [N]
        case study::Rule::depth: return 1e-15 + motion;  // [m]
        case study::Rule::closed_form: return rounding * old;
        case study::Rule::fact: return is_closed_form(column) ? rounding * old : 1e-9 + 1e-2 * old;
        default: return column.starts_with("horizon_s") ? 2 * row : motion;
    }
}

bool same_number(double before, double after, double tolerance) {
    return (std::isnan(before) && std::isnan(after)) || before == after ||
           std::abs(before - after) <= tolerance;
}

// 1: larger is worse, -1: larger is better, 0: neither.
int worse_where_larger(const std::string& column) {
    for (const char* name : {"energy_residual", "error_in_model", "certificate"})
        if (column.starts_with(name)) return 1;
    for (const study::Measure& m : study::measures())
        if (column.starts_with(m.column)) return m.less_is_better ? 1 : -1;
    return 0;
}

bool never_negative(const std::string& column) {
    return worse_where_larger(column) != 0 || study::rule_of(column) == study::Rule::floor;
}

std::set<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

Turn text_turn(const std::string& column, const std::string& before, const std::string& after) {
    if (before == after) return Turn::same;
    if (column == "status")
        return before == "ok" ? Turn::worse : after == "ok" ? Turn::better : Turn::moved;
    if (column == "flags") {  // one that was not there before is worse, whatever else is gone
        const auto lacks_one_of = [](const std::set<std::string>& all,
                                     const std::set<std::string>& of) {
            return !std::ranges::includes(all, of);
        };
        const auto was = words_of(before), is = words_of(after);
        return lacks_one_of(was, is)   ? Turn::worse
               : lacks_one_of(is, was) ? Turn::better
                                       : Turn::same;
    }
    return Turn::moved;
}
}  // namespace

const char* name_of(Turn t) {
    constexpr const char* names[] = {"same", "moved", "better", "worse"};
    return names[static_cast<int>(t)];
}

bool is_cost(const std::string& column) { return study::rule_of(column) == study::Rule::clock; }

bool is_judged(const std::string& column) { return worse_where_larger(column) != 0; }

bool is_skipped(const std::string& column) { return study::rule_of(column) == study::Rule::name; }

Turn turn_of(const std::string& column, const store::Table& before, std::size_t i,
             const store::Table& after, std::size_t k) {
    if (study::rule_of(column) == study::Rule::text)
        return text_turn(column, before.at(i, column), after.at(k, column));
    const double was = before.number(i, column), is = after.number(k, column);
    // no error is: the table is damaged
    if (is < 0 && !(was < 0) && never_negative(column)) return Turn::worse;
    if (same_number(was, is, tolerance_of(column, before, i, after, k))) return Turn::same;
    const int sign = worse_where_larger(column);
    if (sign == 0) return Turn::moved;
    if (std::isnan(was) || std::isnan(is)) return std::isnan(is) ? Turn::worse : Turn::better;
    const auto certain = [&](const store::Table& t, std::size_t at) {
        const double c = compare::bound_of(t, at, column).certificate;
        return std::isnan(c) ? 0 : c;
    };
    const double certain_before = certain(before, i);
    if (!(std::abs(is - was) > certain_before + std::min(certain_before, certain(after, k))))
        return Turn::moved;
    return sign * (is - was) > 0 ? Turn::worse : Turn::better;
}

Turn dispersion_turn(const std::string& column, double before, double after) {
    const double tolerance = column.starts_with("own_") ? 1e-8
                             : column == "trace_cents"  ? 1e-4
                                                        : 1e-3;
    if (same_number(before, after, tolerance)) return Turn::same;
    if (!column.ends_with("_cents")) return Turn::moved;
    if (std::isnan(before) || std::isnan(after))
        return std::isnan(after) ? Turn::worse : Turn::better;
    return std::abs(after) > std::abs(before) ? Turn::worse : Turn::better;
}

}  // namespace jvari::bench::diff
