#include "bench/command/text_table.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/compare/bound.hpp"
#include "bench/store/cell_rows.hpp"
#include "schemes/facts.hpp"

namespace jvari::bench::command {

namespace {
std::size_t shown(const std::string& text) {  // characters of UTF-8
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}
}  // namespace

std::string TextTable::text(std::size_t width) const {
    std::vector<std::size_t> widths, kept(columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
        widths.push_back(shown(columns[k].head));
        for (const Row& row : rows) widths[k] = std::max(widths[k], shown(row.fields.at(k)));
    }
    std::iota(kept.begin(), kept.end(), 0);
    const auto total = [&] {
        return std::accumulate(kept.begin(), kept.end(), std::size_t{0},
                               [&](auto sum, auto k) { return sum + 2 + widths[k]; });
    };
    std::string left_out;
    while (total() > width) {
        const auto last =
            std::ranges::max_element(kept, {}, [this](std::size_t k) { return columns[k].rank; });
        if (columns[*last].rank == 0) break;
        left_out = columns[*last].head + (left_out.empty() ? "" : ", ") + left_out;
        kept.erase(last);
    }
    std::string text;
    const auto line = [&](char mark, const auto& field) {
        std::string fields;
        for (const std::size_t k : kept) {
            const std::string padding(widths[k] - shown(field(k)), ' ');
            fields += (columns[k].left ? field(k) + padding : padding + field(k)) + "  ";
        }
        text +=
            std::string(1, mark) + " " + fields.substr(0, fields.find_last_not_of(' ') + 1) + "\n";
    };
    line(' ', [&](std::size_t k) { return columns[k].head; });
    for (const Row& row : rows) line(row.mark, [&](std::size_t k) { return row.fields[k]; });
    if (!left_out.empty())
        text += "Not shown, because the terminal is narrow: " + left_out +
                ". --json and the tables of --out have them.\n";
    return text;
}

namespace {
constexpr const char* errors[] = {"error_l2_10ms", "error_l2_50ms", "error_l2_whole"};

std::string cell_text(const store::Table& t, std::size_t row, const char* column,
                      const char* format) {
    const double x = t.number(row, column);
    return std::isnan(x) ? "-" : fmt::format(fmt::runtime(format), x);
}

// "x 1.3 %": half the distance of the quartiles over the median.
std::string spread_text(const store::Table& t, std::size_t row) {
    const double median = t.number(row, "wall_seconds"),
                 half = 0.5 *
                        (t.number(row, "wall_seconds_upper") - t.number(row, "wall_seconds_lower"));
    return std::isnan(half / median) ? "" : fmt::format("+-{:.0f}%", 100 * half / median);
}
std::string window_name(const std::string& error) {
    return error == "error_l2_50ms"   ? "the first 50 ms"
           : error == "error_l2_10ms" ? "the first 10 ms"
                                      : "the run";
}
}  // namespace

std::string headline_text(const store::Table& t, std::size_t width) {
    const std::string headline = compare::headline_error(t, store::all_rows(t));
    const auto error = [&headline](const char* head, const char* column) {
        return TextTable::Column{head, false, column == headline ? 0 : 3};
    };
    TextTable table{{{"scheme", true},
                     {"rate"},
                     {"modes", false, 2},
                     error("L2 10ms", errors[0]),
                     error("L2 50ms", errors[1]),
                     error("L2 whole", errors[2]),
                     {"horizon", false, 5},
                     {"1/3 oct", false, 4},
                     {"residual", false, 6},
                     {"s per s"},
                     {"", true, 1},
                     {"real time", false, 7},
                     {"ns/step", false, 8}},
                    {}};
    TextTable::Row certificate{' ', {"(uncertainty of the reference)", "", ""}};
    for (const char* column : errors) {
        const double x =
            t.rows.empty() ? std::nan("") : compare::bound_of(t, 0, column).certificate;
        certificate.fields.push_back(std::isnan(x) ? "unknown" : fmt::format("{:.2e}", x));
    }
    certificate.fields.resize(table.columns.size());
    table.rows.push_back(std::move(certificate));
    std::string missing, flagged, untimed;
    std::size_t left_out = 0;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const std::string& status = t.at(i, "status");
        if (status == "not_needed") {
            ++left_out;
            continue;
        }
        if (status == "refused") {
            const std::string who = store::run_name(t, i),
                              why = " refused: " + t.at(i, "reason") + "\n";
            if (const auto same = missing.find(why); same != std::string::npos)
                missing.insert(same, "; " + who);
            else missing += "  " + who + why;
            continue;
        }
        if (status != "ok")
            missing += fmt::format("  {} {}\n", store::run_name(t, i), t.at(i, "reason"));
        if (const std::string& cost = t.at(i, "cost_s_per_s");
            !cost.empty() && std::isnan(t.number(i, "cost_s_per_s")))
            untimed += fmt::format("\ncost of {}: {}", store::run_name(t, i), cost);
        if (!t.at(i, "flags").empty())
            flagged += fmt::format("  {}: {} (smallest contact force {}, ledger open by {})\n",
                                   store::run_name(t, i), t.at(i, "flags"),
                                   cell_text(t, i, facts::smallest_contact_force.name, "{:.2g} N"),
                                   cell_text(t, i, "energy_residual_accumulated", "{:.1e}"));
        TextTable::Row row{
            t.at(i, "pareto") == "1"    ? '*'
            : !t.at(i, "flags").empty() ? '!'
                                        : ' ',
            {store::variant_name(t.at(i, "scheme"), t.at(i, "options")),
             t.at(i, "rate").empty() ? "contin." : t.at(i, "rate"), t.at(i, "modes")}};
        for (const char* column : errors)
            row.fields.push_back(compare::error_text(compare::bound_of(t, i, column), "{:.2e}"));
        for (const auto& [column, format] : {std::pair{"horizon_s", "{:.4f} s"},
                                             {"third_octave_db", "{:.2f} dB"},
                                             {"energy_residual_accumulated", "{:.1e}"},
                                             {"cost_s_per_s", "{:.3g}"}})
            row.fields.push_back(cell_text(t, i, column, format));
        row.fields.push_back(spread_text(t, i));
        row.fields.push_back(cell_text(t, i, "times_real_time", "{:.3g}"));
        row.fields.push_back(cell_text(t, i, "ns_per_step", "{:.1f}"));
        table.rows.push_back(std::move(row));
    }
    std::string text = table.text(width);
    if (const double from = t.rows.empty() ? 0 : t.number(0, "free_from_s"); from > 0)
        text += fmt::format(
            "errors are of what follows the last pluck: their windows begin at {:.6g} s\n", from);
    text += fmt::format(
        "* on the Pareto front of {} and cost; +- is half the distance of the quartiles", headline);
    const auto says = [&t](compare::Bound::Says what) {
        for (std::size_t i = 0; i < t.rows.size(); ++i)
            for (const char* column : errors)
                if (compare::bound_of(t, i, column).says() == what) return true;
        return false;
    };
    text += untimed;
    if (left_out > 0)
        text += fmt::format(
            "\n{} more combinations of modes, rate and compliance were run over {} alone: a "
            "cheaper one does as well there",
            left_out, window_name(headline) + compare::after_pluck(t, 0));
    if (says(compare::Bound::Says::at_most))
        text +=
            "\n\u2264 upper bound: the error and the uncertainty of the reference, which is more "
            "than a tenth of it";
    if (says(compare::Bound::Says::unknown)) text += "\nnot known: together they reach 100 %";
    if (says(compare::Bound::Says::unsure))
        text += "\n? measured against a reference whose own uncertainty is unknown";
    if (!flagged.empty())
        text += "\n! not to be trusted, whatever the error says\n" +
                flagged.substr(0, flagged.size() - 1);
    return missing.empty() ? text
                           : text + "\nfailed or refused\n" + missing.substr(0, missing.size() - 1);
}

}  // namespace jvari::bench::command
