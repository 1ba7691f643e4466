#include "bench/command/console.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bench/compare/bound.hpp"
#include "bench/compare/scene_notes.hpp"
#include "schemes/facts.hpp"

namespace jvari::bench::command {

namespace {
std::size_t shown(const std::string& text) {  // counts UTF-8 characters
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}
}  // namespace

store::Lines TextTable::lines(std::size_t width) const {
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
    store::Lines lines;
    const auto line = [&](char mark, const auto& field) {
        std::string fields;
        for (const std::size_t k : kept) {
            const std::string padding(widths[k] - shown(field(k)), ' ');
            fields += (columns[k].left ? field(k) + padding : padding + field(k)) + "  ";
        }
        lines.push_back(
            {std::string(1, mark) + " " + fields.substr(0, fields.find_last_not_of(' ') + 1),
             mark == '*'   ? store::Mark::best
             : mark == '!' ? store::Mark::doubtful
                           : store::Mark::none});
    };
    line(' ', [&](std::size_t k) { return columns[k].head; });
    for (const Row& row : rows) line(row.mark, [&](std::size_t k) { return row.fields[k]; });
    if (!left_out.empty())
        lines.push_back({"Not shown, because the terminal is narrow: " + left_out +
                         ". --json and the tables of --out have them."});
    return lines;
}

namespace {
constexpr const char* errors[] = {"error_l2_10ms", "error_l2_50ms", "error_l2_whole"};

std::string formatted(double x, const char* format) {
    return std::isnan(x) ? "-" : fmt::format(fmt::runtime(format), x);
}

// Half the distance between the quartiles over the median: "+-1%".
std::string spread_text(const study::TabledCell& c) {
    const double half = 0.5 * (c.wall_seconds_upper - c.wall_seconds_lower);
    return std::isnan(half / c.wall_seconds)
               ? ""
               : fmt::format("+-{:.0f}%", 100 * half / c.wall_seconds);
}
std::string window_name(const std::string& error) {
    return error == "error_l2_50ms"   ? "the first 50 ms"
           : error == "error_l2_10ms" ? "the first 10 ms"
                                      : "the run";
}

TextTable::Row certificate_row(const study::Cells& cells, std::size_t columns) {
    TextTable::Row row{' ', {"(uncertainty of the reference)", "", ""}};
    for (const char* column : errors) {
        const double x =
            cells.empty() ? std::nan("") : cells[0].figure(study::measure(column)).certificate;
        row.fields.push_back(std::isnan(x) ? "unknown" : fmt::format("{:.2e}", x));
    }
    row.fields.resize(columns);
    return row;
}

TextTable::Row row_of(const study::TabledCell& c) {
    TextTable::Row row{c.pareto == true   ? '*'
                       : !c.flags.empty() ? '!'
                                          : ' ',
                       {c.variant(), std::isnan(c.rate) ? "contin." : store::text_of(c.rate),
                        store::text_of(c.modes)}};
    for (const char* column : errors)
        row.fields.push_back(
            compare::error_text(compare::bound_of(c, study::measure(column)), "{:.2e}"));
    const auto value = [&c](const char* measure) {
        return c.figure(study::measure(measure)).value;
    };
    for (const std::string& text :
         {std::isnan(value("horizon_s")) ? "-" : compare::time_text(value("horizon_s")),
          formatted(value("third_octave_db"), "{:.2f} dB"),
          formatted(c.energy_residual_accumulated, "{:.1e}"), formatted(c.cost_s_per_s, "{:.3g}"),
          spread_text(c), formatted(c.times_real_time, "{:.3g}"),
          formatted(c.ns_per_step, "{:.1f}")})
        row.fields.push_back(text);
    return row;
}

std::string flag_text(const study::TabledCell& c) {
    return fmt::format("  {}: {} (smallest contact force {}, ledger open by {})", c.run(), c.flags,
                       formatted(c.smallest_contact_force, "{:.2g} N"),
                       formatted(c.energy_residual_accumulated, "{:.1e}"));
}

// Explains the signs beside errors that occur in the table.
store::Lines legend_of_bounds(const study::Cells& cells) {
    const auto says = [&cells](compare::Bound::Says what) {
        return std::ranges::any_of(cells, [what](const study::TabledCell& c) {
            return std::ranges::any_of(errors, [&](const char* column) {
                return compare::bound_of(c, study::measure(column)).says() == what;
            });
        });
    };
    store::Lines lines;
    if (says(compare::Bound::Says::at_most))
        lines.push_back(
            {"\u2264 upper bound: the error and the uncertainty of the reference, which is more "
             "than a tenth of it"});
    if (says(compare::Bound::Says::unknown))
        lines.push_back({"not known: together they reach 100 %"});
    if (says(compare::Bound::Says::unsure))
        lines.push_back({"? measured against a reference whose own uncertainty is unknown"});
    return lines;
}
// Refusals for one reason share a line.
store::Lines failures_of(const study::Cells& cells) {
    store::Lines lines;
    std::map<std::string, std::size_t> refused;  // lines by their reasons
    for (const study::TabledCell& c : cells) {
        if (c.status == "ok" || c.status == "not_needed") continue;
        if (c.status != "refused") {
            lines.push_back({fmt::format("  {} {}", c.run(), c.reason)});
            continue;
        }
        const auto [known, is_new] = refused.try_emplace(c.reason, lines.size());
        if (is_new) lines.push_back({"  " + c.run()});
        else lines[known->second].text += "; " + c.run();
    }
    for (const auto& [reason, line] : refused) lines[line].text += " refused: " + reason;
    if (!lines.empty()) lines.insert(lines.begin(), {"failed or refused"});
    return lines;
}
}  // namespace

store::Lines headline_lines(const study::Cells& cells, std::size_t width) {
    const std::string headline =
        study::measures()[compare::headline_error(cells, study::all_rows(cells))].column;
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
    table.rows.push_back(certificate_row(cells, table.columns.size()));
    store::Lines flagged, untimed;
    std::size_t left_out = 0;
    for (const study::TabledCell& c : cells) {
        if (c.status == "not_needed") ++left_out;
        if (c.status == "not_needed" || c.status == "refused") continue;
        if (!c.untimed.empty())
            untimed.push_back({fmt::format("cost of {}: {}", c.run(), c.untimed)});
        if (!c.flags.empty()) flagged.push_back({flag_text(c)});
        table.rows.push_back(row_of(c));
    }
    store::Lines lines = table.lines(width);
    const auto add = [&lines](const store::Lines& more) {
        lines.insert(lines.end(), more.begin(), more.end());
    };
    if (const double from = cells.empty() ? 0 : cells[0].free_from_s; from > 0)
        add({{fmt::format(
            "errors are of what follows the last pluck: their windows begin at {:.6g} s", from)}});
    add({{fmt::format(
              "* on the Pareto front of {} and cost; +- is half the distance of the quartiles",
              headline),
          store::Mark::best}});
    add(untimed);
    if (left_out > 0)
        add({{fmt::format("{} further runs were ended after {}: a cheaper one is as accurate",
                          left_out, window_name(headline) + compare::after_pluck(cells[0]))}});
    add(legend_of_bounds(cells));
    if (!flagged.empty())
        add({{"! not to be trusted, whatever the error says", store::Mark::doubtful}});
    add(flagged);
    add(failures_of(cells));
    return lines;
}

}  // namespace jvari::bench::command
