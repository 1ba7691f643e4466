// Text of a difference, for people and for programs.
#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/store/json.hpp"
#include "bench/suite/difference.hpp"

namespace jvari::bench::suite {

namespace {
using Json = nlohmann::ordered_json;

std::string shown(const store::Field& field) {
    if (field.empty()) return "-";
    const double x = field.number();
    return std::isnan(x) ? field.text() : fmt::format("{:.4g}", x);
}

std::string change_of(const Finding& f) {
    const double was = f.before.number(), is = f.after.number();
    if (!std::isfinite(was) || !std::isfinite(is) || was == 0) return "";
    const double change = 100 * (is / was - 1);
    return std::abs(change) < 1000 ? fmt::format("{:+.2g} %", change)
                                   : fmt::format("{:.3g} times", is / was);
}

// Lines for rows: the first finding, which is the headline's, and the number of further findings.
std::string findings_text(const Difference& d, Turn turn, const std::string& title,
                          std::size_t most) {
    std::vector<const Finding*> first;
    std::vector<int> more;
    int all = 0;
    for (const Finding& f : d.findings) {
        if (f.turn != turn) continue;
        ++all;
        if (!first.empty() && first.back()->row == f.row &&
            (first.back()->column == "cost_s_per_s") == (f.column == "cost_s_per_s"))
            ++more.back();
        else first.push_back(&f), more.push_back(0);
    }
    if (all == 0) return "";
    std::string text = fmt::format("\n{}\n", title);
    std::size_t width = 0;
    for (std::size_t i = 0; i < std::min(most, first.size()); ++i)
        width = std::max(width, first[i]->row.size());
    for (std::size_t i = 0; i < std::min(most, first.size()); ++i) {
        const Finding& f = *first[i];
        text += fmt::format("  {:<{}}  {:<22} {:>10} -> {:<10} {}", f.row, width, f.column,
                            shown(f.before), shown(f.after),
                            f.detail.empty() ? change_of(f) : f.detail);
        while (text.back() == ' ') text.pop_back();
        text += more[i] > 0 ? fmt::format("   and {} more\n", more[i]) : "\n";
    }
    if (first.size() > most)
        text += fmt::format("  and {} rows more; --json has them all\n", first.size() - most);
    return text;
}

std::string only_text(const char* what, const char* where, const std::vector<std::string>& names,
                      std::size_t most) {
    if (names.empty()) return "";
    std::string text = fmt::format("\n{} only {} ({})\n", what, where, names.size());
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += "  " + names[i] + "\n";
    if (names.size() > most)
        text += fmt::format("  and {} more; --json has them all\n", names.size() - most);
    return text;
}

Json json_of(const Results& f) {
    return {{"folder", f.name},
            {"commit", f.provenance.commit},
            {"date", f.provenance.date},
            {"machine", f.provenance.machine()},
            {"compiler", f.provenance.compiler},
            {"flags", f.provenance.flags},
            {"build", f.provenance.build}};
}
}  // namespace

std::string text_of(const Difference& d, const Results& before, const Results& after,
                    std::size_t most) {
    // first, because the figures below rest on the references
    std::string text = d.references.empty() ? "" : d.references + "\n";
    for (const auto& [name, f] : {std::pair{"before", &before}, std::pair{"after", &after}})
        text += fmt::format("{:<7} {}: commit {}, {}, {}\n", name, f->name, f->provenance.commit,
                            f->provenance.date, f->provenance.machine());
    for (const std::string& note : d.notes) text += "note: " + note + "\n";
    text += fmt::format(
        "{} cells in both, {} fields compared: {} worse, {} better, {} moved{}\n", d.cells_in_both,
        d.compared, d.count(Turn::worse), d.count(Turn::better), d.count(Turn::moved),
        d.missing() > 0 ? fmt::format(", {} missing after, which counts as worse", d.missing())
                        : "");
    if (d.cells_in_both > 0)
        text += fmt::format("{} of {} cells came back to the last digit\n", d.to_the_last_digit,
                            d.cells_in_both);
    text += findings_text(d, Turn::worse, "worse", most);
    text += findings_text(d, Turn::better, "better", most);
    text += findings_text(d, Turn::moved, "moved: neither better nor worse for certain", most);
    for (const auto& [what, only] : d.alone())
        text += only_text(what, "before", only->before, most) +
                only_text(what, "after", only->after, most);
    text.pop_back();
    return text;
}

std::string json_of(const Difference& d, const Results& before, const Results& after) {
    Json findings = Json::array();
    for (const Finding& f : d.findings)
        findings.push_back({{"turn", name_of(f.turn)},
                            {"row", f.row},
                            {"column", f.column},
                            {"before", f.before.text()},
                            {"after", f.after.text()},
                            {"detail", f.detail}});
    Json alone = Json::object();
    for (const auto& [what, only] : d.alone())
        alone[what] = {{"before", only->before}, {"after", only->after}};
    return store::indented({{"status", d.worse()     ? "worse"
                                       : d.nothing() ? "same"
                                                     : "changed"},
                            {"before", json_of(before)},
                            {"after", json_of(after)},
                            {"references", d.references},
                            {"cells_in_both", d.cells_in_both},
                            {"to_the_last_digit", d.to_the_last_digit},
                            {"fields_compared", d.compared},
                            {"worse", d.count(Turn::worse)},
                            {"better", d.count(Turn::better)},
                            {"moved", d.count(Turn::moved)},
                            {"missing", d.missing()},
                            {"findings", findings},
                            {"only", alone},
                            {"notes", d.notes}});
}

}  // namespace jvari::bench::suite
