#include "bench/diff/rules.hpp"

#include <algorithm>
#include <cmath>

#include "bench/compare/bound.hpp"
#include "bench/compare/errors.hpp"

namespace jvari::bench::diff {

namespace {
constexpr double floors = 1000, rounding = 1e-9, centroid = 1e3;  // [Hz]
constexpr double row = 1.0 / 44100;                               // [s]

template <std::size_t n>
bool one_of(const std::string& column, const char* const (&names)[n]) {
    return std::any_of(names, names + n, [&](const char* name) { return column == name; });
}
template <std::size_t n>
bool begins(const std::string& column, const char* const (&names)[n]) {
    return std::any_of(names, names + n, [&](const char* name) { return column.starts_with(name); });
}

bool is_text(const std::string& column) {
    return one_of(column, {"scene", "scheme", "options", "status", "flags", "reference", "reference_doubling", "reason"});
}

bool is_closed_form(const std::string& column) {  // or a count that the settings fix
    return begins(
        column, {"fact_static_compliance", "fact_start_phase_offset", "fact_start_phase_error", "fact_period_error_cents", "fact_loss_fit_",
                 "fact_grid_intervals", "fact_interior_nodes", "fact_modes_above_nyquist", "fact_contact_points", "fact_bridge_nodes",
                 "fact_theta", "fact_stable_stiffness_limit", "rate", "modes", "dofs", "state_bytes", "steps"});
}

// The row's own sensitivity: the largest noise floor of its relative L2 errors.
double sensitivity(const store::Table& t, std::size_t i) {
    double largest = 0;
    for (const std::string& column : t.columns)
        if (column.starts_with("floor_error_l2_whole")) largest = std::fmax(largest, t.number(i, column));
    return largest;
}

// error_in_model_l2_50ms, third_octave_db_in_model_nut: the error of that name against the scene, which has a noise floor.
std::string against_the_scene(std::string column) {
    const std::string part = "_in_model";
    if (const auto at = column.find(part); at != std::string::npos) column.erase(at, part.size());
    return column;
}

double tolerance_of(const std::string& column, const store::Table& before, std::size_t i) {
    const double old = std::abs(before.number(i, column)), motion = (floors * sensitivity(before, i) + 1e-6) * old;
    const std::string of_scene = against_the_scene(column);
    if (const double floor = before.number(i, "floor_" + of_scene); !std::isnan(floor)) {
        const double noise = floors * floor + rounding * (old + (column.starts_with("centroid_hz") ? centroid : 0));
        return of_scene == column ? noise : std::fmax(noise, motion);
    }
    if (column.starts_with("floor_")) return 9 * old + 1e-9;
    if (column.starts_with("horizon_s") || column == "failed_at_s") return 2 * row;
    if (column == "failed_step") return 2;
    if (column.starts_with("energy_residual")) return 1e-9 + motion;
    if (column == "smallest_contact_force") return 1e-9 + motion;  // [N]
    if (column == "deepest_penetration") return 1e-15 + motion;    // [m]
    if (is_closed_form(column)) return rounding * old;
    if (column.starts_with("fact_")) return 1e-9 + 1e-2 * old;
    return motion;
}

bool same_number(double before, double after, double tolerance) {
    return (std::isnan(before) && std::isnan(after)) || before == after || std::abs(before - after) <= tolerance;
}

// 1: larger is worse, -1: larger is better, 0: neither.
int worse_where_larger(const std::string& column) {
    for (const char* name : {"energy_residual", "error_in_model", "certificate"})
        if (column.starts_with(name)) return 1;
    for (const compare::Measure& m : compare::measures())
        if (column.starts_with(m.column)) return m.less_is_better ? 1 : -1;
    return 0;
}

Turn text_turn(const std::string& column, const std::string& before, const std::string& after) {
    if (before == after) return Turn::same;
    if (column == "status") return before == "ok" ? Turn::worse : after == "ok" ? Turn::better : Turn::moved;
    if (column == "flags") return before.empty() ? Turn::worse : after.empty() ? Turn::better : Turn::moved;
    return Turn::moved;
}
}  // namespace

const char* name_of(Turn t) {
    constexpr const char* names[] = {"same", "moved", "better", "worse"};
    return names[static_cast<int>(t)];
}

bool is_cost(const std::string& column) {
    return one_of(column,
                  {"pareto", "repeats", "ns_per_step", "times_real_time", "worst_block_of_deadline", "machine", "load", "governor"}) ||
           begins(column, {"cost_", "processor_", "wall_seconds"});
}

bool is_judged(const std::string& column) {
    return worse_where_larger(column) != 0;
}

bool is_skipped(const std::string& column) {
    return column == "cell" || column == "below_floor";
}

Turn turn_of(const std::string& column, const store::Table& before, std::size_t i, const store::Table& after, std::size_t k) {
    if (is_text(column)) return text_turn(column, before.at(i, column), after.at(k, column));
    const double was = before.number(i, column), is = after.number(k, column);
    if (same_number(was, is, tolerance_of(column, before, i))) return Turn::same;
    const int sign = worse_where_larger(column);
    if (sign == 0) return Turn::moved;
    if (std::isnan(was) || std::isnan(is)) return std::isnan(is) ? Turn::worse : Turn::better;
    const auto certain = [&](const store::Table& t, std::size_t at) {
        const double c = compare::bound_of(t, at, column).certificate;
        return std::isnan(c) ? 0 : c;
    };
    const double certain_before = certain(before, i);
    if (!(std::abs(is - was) > certain_before + std::min(certain_before, certain(after, k)))) return Turn::moved;
    return sign * (is - was) > 0 ? Turn::worse : Turn::better;
}

Turn dispersion_turn(const std::string& column, double before, double after) {
    const double tolerance = column.starts_with("own_") ? 1e-8 : column == "trace_cents" ? 1e-4 : 1e-3;
    if (same_number(before, after, tolerance)) return Turn::same;
    if (!column.ends_with("_cents")) return Turn::moved;
    if (std::isnan(before) || std::isnan(after)) return std::isnan(after) ? Turn::worse : Turn::better;
    return std::abs(after) > std::abs(before) ? Turn::worse : Turn::better;
}

}  // namespace jvari::bench::diff
