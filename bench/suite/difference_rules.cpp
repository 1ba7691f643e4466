// Rules for numbers of a cell: how far a number may move without counting, and which direction is
// worse.
//
// An error figure may move by 1000 times its noise floor plus 1e-9 of itself. The noise floor is
// the change in the reference after a relative change of the start by 1e-12, for the same scene,
// window and tap. A centroid difference compares two tracks of about a kilohertz and does not
// depend on the scale of the start, so 1e-9 of a kilohertz is added. The tolerance thus covers
// relative changes of 1e-9. Another vector width changes the order of sums. With SSE2 in place of
// AVX-512, 5 of 6632 figures in the smoke suite moved by more than 100 floors, and only centroids
// by more than 350. A changed equation moves figures by far more.
//
// Numbers that follow the motion and have no noise floor (contact force, penetration, certificates
// for stand-ins) may move by 1000 times the cell's largest floor plus 1e-6 of themselves. An error
// against a reference with the cell's modes has the larger of both tolerances. The other
// tolerances:
//   closed forms   facts and the modes' own frequencies: 1e-9
//   pencil         results from a trace by the matrix pencil: 1e-4 cents
//   ledger         residuals: the tolerance for the motion, plus 1e-9
//   instant        two rows
//   noise floor    a factor of ten, because a floor is rounding itself
//   iterations     counts and residuals: a hundredth. The most in one step: a tenth, because one
//                  step decides it: AVX2 in place of AVX-512 gives 29 for 27
//
// An error with a larger move is better or worse if the move exceeds both certificates together.
// Otherwise neither side knows the true error so well, and the error only moved. The later
// certificate counts no more than the earlier, and a larger certificate is itself worse: less
// knowledge excuses no result. A known number that becomes unknown is worse.
#include "bench/suite/difference.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>

#include "schemes/facts.hpp"

namespace jvari::bench::suite {

namespace {
using Cell = study::TabledCell;

constexpr double floors = 1000, rounding = 1e-9, centroid = 1e3;  // [Hz]
constexpr double row = 1.0 / 44100;                               // [s]

// True for facts from closed forms, or counts that the settings fix.
bool is_closed_form(const std::string& fact) {
    constexpr const char* names[] = {"static_compliance",
                                     "start_phase_offset",
                                     "start_phase_error",
                                     "period_error_cents",
                                     "loss_fit_",
                                     "grid_intervals",
                                     "interior_nodes",
                                     "modes_above_nyquist",
                                     "contact_points",
                                     "bridge_nodes",
                                     "theta",
                                     "stable_stiffness_limit"};
    return std::ranges::any_of(names, [&](const char* name) { return fact.starts_with(name); });
}

// Sensitivity of a cell: the largest noise floor among its relative L2 errors.
double sensitivity(const Cell& c) {
    double largest = 0;
    for (const std::string& tap : c.taps)
        largest = std::fmax(largest, c.figure(study::measure("error_l2_whole"), tap).floor);
    return largest;
}

// Tolerance for a number that follows the motion and has no noise floor. The lower of the two
// cells' sensitivities counts, so a floor raised in either folder excuses nothing.
double motion(const Cell& before, const Cell& after, double old) {
    return (floors * std::min(sensitivity(before), sensitivity(after)) + 1e-6) * std::abs(old);
}

bool same_number(double before, double after, double tolerance) {
    return (std::isnan(before) && std::isnan(after)) || before == after ||
           std::abs(before - after) <= tolerance;
}

// Scale for a changed number. sign: 1: larger is worse, -1: larger is better, 0: neither.
// `certain`: certificates before and after; the change has to exceed them.
struct Scale {
    double tolerance;
    int sign = 0;
    bool never_negative = false;
    double certain_before = 0, certain_after = 0;
};
Turn turn_of(double was, double is, const Scale& s) {
    // no error is negative: the table is damaged
    if (is < 0 && !(was < 0) && (s.sign != 0 || s.never_negative)) return Turn::worse;
    if (same_number(was, is, s.tolerance)) return Turn::same;
    if (s.sign == 0) return Turn::moved;
    if (std::isnan(was) || std::isnan(is)) return std::isnan(is) ? Turn::worse : Turn::better;
    const auto known = [](double certificate) { return std::isnan(certificate) ? 0 : certificate; };
    const double before = known(s.certain_before);
    if (!(std::abs(is - was) > before + std::min(before, known(s.certain_after))))
        return Turn::moved;
    return s.sign * (is - was) > 0 ? Turn::worse : Turn::better;
}

std::set<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

Turn turn_of(const std::string& column, const std::string& before, const std::string& after) {
    if (before == after) return Turn::same;
    if (column == "status")
        return before == "ok" ? Turn::worse : after == "ok" ? Turn::better : Turn::moved;
    if (column == "flags") {  // a new flag is worse, even if another is gone
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

Turn turn_of(const study::Column& column, const Cell& before, const Cell& after) {
    const auto* number = std::get_if<double Cell::*>(&column.field);
    if (!number)
        return turn_of(column.name, column.value(before).text(), column.value(after).text());
    const double was = before.*(*number), is = after.*(*number), moves = motion(before, after, was);
    switch (column.rule) {
        case study::Rule::instant: return turn_of(was, is, {2 * row});
        case study::Rule::step: return turn_of(was, is, {2});
        case study::Rule::ledger: return turn_of(was, is, {1e-9 + moves, 1});  // [1]
        case study::Rule::force: return turn_of(was, is, {1e-9 + moves});      // [N]
        case study::Rule::depth: return turn_of(was, is, {1e-15 + moves});     // [m]
        default: return turn_of(was, is, {rounding * std::abs(was)});
    }
}

Turn turn_of_fact(const std::string& name, const Cell& before, const Cell& after) {
    const double was = before.fact(name), old = std::abs(was);
    const double is = after.fact(name);
    if (is_closed_form(name)) return turn_of(was, is, {rounding * old});
    const double part = name == facts::contact_iterations_most.name ? 1e-1 : 1e-2;
    return turn_of(was, is, {1e-9 + part * old});
}

Turn turn_of(double study::Figure::*part, std::size_t measure, const std::string& tap,
             const Cell& before, const Cell& after) {
    using F = study::Figure;
    const F &b = before.figure(measure, tap), &a = after.figure(measure, tap);
    const study::Measure& m = study::measures()[measure];
    const double was = b.*part, is = a.*part, old = std::abs(was),
                 moves = motion(before, after, was), floor = std::fmin(b.floor, a.floor);
    if (part == &F::floor) return turn_of(was, is, {9 * old + 1e-9, 0, true});
    if (part == &F::certificate || part == &F::certificate_in_model)
        return turn_of(was, is, {moves, 1});
    const double noise =
        floors * floor + rounding * (old + (m.column == "centroid_hz" ? centroid : 0));
    const bool in_model = part == &F::in_model;
    const double tolerance = !std::isnan(floor) ? (in_model ? std::fmax(noise, moves) : noise)
                             : m.unit == "s"    ? 2 * row
                                                : moves;
    const auto certificate = in_model ? &F::certificate_in_model : &F::certificate;
    return turn_of(was, is,
                   {tolerance, m.less_is_better ? 1 : -1, true, b.*certificate, a.*certificate});
}

}  // namespace jvari::bench::suite
