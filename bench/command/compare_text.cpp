#include "bench/command/compare_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/compare/bound.hpp"
#include "bench/store/cell_rows.hpp"
#include "schemes/facts.hpp"

namespace jvari::bench::command {

namespace {
std::string cell_text(const store::Table& t, std::size_t row, const char* column, const char* format) {
    const double x = t.number(row, column);
    return std::isnan(x) ? "-" : fmt::format(fmt::runtime(format), x);
}

// "x 1.3 %": half the distance of the quartiles over the median.
std::string spread_text(const store::Table& t, std::size_t row) {
    const double median = t.number(row, "wall_seconds"),
                 half = 0.5 * (t.number(row, "wall_seconds_upper") - t.number(row, "wall_seconds_lower"));
    return std::isnan(half / median) ? "" : fmt::format("+-{:.0f}%", 100 * half / median);
}
std::string window_name(const std::string& error) {
    return error == "error_l2_50ms" ? "the first 50 ms" : error == "error_l2_10ms" ? "the first 10 ms" : "the run";
}
}  // namespace

std::string headline_text(const store::Table& t) {
    static const std::string certificate = "(uncertainty of the reference)";
    const auto name = [&t](std::size_t i) { return store::variant_name(t.at(i, "scheme"), t.at(i, "options")); };
    std::size_t width = certificate.size(), left_out = 0;
    for (std::size_t i = 0; i < t.rows.size(); ++i) width = std::max(width, name(i).size());
    std::string text =
        fmt::format("  {:<{}}  {:>9} {:>6}  {:>9} {:>9} {:>9}  {:>8} {:>8} {:>8}  {:>9} {:<6} {:>9} {:>8}\n", "scheme", width, "rate",
                    "modes", "L2 10ms", "L2 50ms", "L2 whole", "horizon", "1/3 oct", "residual", "s per s", "", "real time", "ns/step");
    const auto figure = [&t](const char* column) {
        const double x = t.rows.empty() ? std::nan("") : compare::bound_of(t, 0, column).certificate;
        return std::isnan(x) ? "unknown" : fmt::format("{:.2e}", x);
    };
    text += fmt::format("  {:<{}}  {:>9} {:>6}  {:>9} {:>9} {:>9}\n", certificate, width, "", "", figure("error_l2_10ms"),
                        figure("error_l2_50ms"), figure("error_l2_whole"));
    std::string missing, flagged;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const std::string rate = t.at(i, "rate").empty() ? "contin." : t.at(i, "rate");
        if (t.at(i, "status") == "not_needed") {
            ++left_out;
            continue;
        }
        if (t.at(i, "status") == "refused") {
            missing += fmt::format("  {} refused: {}\n", store::run_name(t, i), t.at(i, "reason"));
            continue;
        }
        if (t.at(i, "status") != "ok") missing += fmt::format("  {} {}\n", store::run_name(t, i), t.at(i, "reason"));
        if (!t.at(i, "flags").empty())
            flagged += fmt::format("  {}: {} (smallest contact force {}, ledger open by {})\n", store::run_name(t, i), t.at(i, "flags"),
                                   cell_text(t, i, facts::smallest_contact_force.name, "{:.2g} N"),
                                   cell_text(t, i, "energy_residual_accumulated", "{:.1e}"));
        text += fmt::format("{} {:<{}}  {:>9} {:>6}  {:>9} {:>9} {:>9}  {:>8} {:>8} {:>8}  {:>9} {:<6} {:>9} {:>8}\n",
                            t.at(i, "pareto") == "1"    ? "*"
                            : !t.at(i, "flags").empty() ? "!"
                                                        : " ",
                            name(i), width, rate, t.at(i, "modes"), compare::error_text(compare::bound_of(t, i, "error_l2_10ms"), "{:.2e}"),
                            compare::error_text(compare::bound_of(t, i, "error_l2_50ms"), "{:.2e}"),
                            compare::error_text(compare::bound_of(t, i, "error_l2_whole"), "{:.2e}"),
                            cell_text(t, i, "horizon_s", "{:.4f} s"), cell_text(t, i, "third_octave_db", "{:.2f} dB"),
                            cell_text(t, i, "energy_residual_accumulated", "{:.1e}"), cell_text(t, i, "cost_s_per_s", "{:.3g}"),
                            spread_text(t, i), cell_text(t, i, "times_real_time", "{:.3g}"), cell_text(t, i, "ns_per_step", "{:.1f}"));
    }
    text += fmt::format("* on the Pareto front of {} and cost; +- is half the distance of the quartiles",
                        compare::headline_error(t, store::all_rows(t)));
    const auto says = [&t](compare::Bound::Says what) {
        for (std::size_t i = 0; i < t.rows.size(); ++i)
            for (const char* column : {"error_l2_10ms", "error_l2_50ms", "error_l2_whole"})
                if (compare::bound_of(t, i, column).says() == what) return true;
        return false;
    };
    if (left_out > 0)
        text += fmt::format("\n{} more combinations of modes, rate and compliance were run over {} alone: a cheaper one does as well there",
                            left_out, window_name(compare::headline_error(t, store::all_rows(t))));
    if (says(compare::Bound::Says::at_most))
        text += "\n\u2264 upper bound: the error and the uncertainty of the reference, which is more than a tenth of it";
    if (says(compare::Bound::Says::unknown)) text += "\nnot known: together they reach 100 %";
    if (says(compare::Bound::Says::unsure)) text += "\n? measured against a reference whose own uncertainty is unknown";
    if (!flagged.empty()) text += "\n! not to be trusted, whatever the error says\n" + flagged.substr(0, flagged.size() - 1);
    return missing.empty() ? text : text + "\nfailed or refused\n" + missing.substr(0, missing.size() - 1);
}

}  // namespace jvari::bench::command
