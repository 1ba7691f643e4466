// What a scene needs: the path from the whole scene to the trimmed one, and what each of its parts is needed for (path.csv, needs.csv).
#include <fmt/core.h>

#include "bench/report/sections/page_sections.hpp"

namespace jvari::bench::report {

namespace {
// Steps as they stand on an axis, where names that occur twice stay apart, and the scheme of each as charts name it.
store::Table labelled(store::Table path) {
    path.columns.insert(path.columns.end(), {"label", "series"});
    for (std::size_t i = 0; i < path.rows.size(); ++i) {
        const std::string label = fmt::format("{}. {}", path.at(i, "step"), path.at(i, "change")),
                          series = store::variant_name(path.at(i, "scheme"), path.at(i, "options"));
        path.rows[i].insert(path.rows[i].end(), {label, series});
    }
    return path;
}
}  // namespace

Section path_section(const Results& r) {
    Section s{"path", "From the whole scene to the trimmed one"};
    if (r.path.rows.empty()) return s;
    const store::Table path = labelled(r.path);
    const Filling filling{r.name,
                          "each step leaves out one thing more; dotted: the tolerance",
                          distinct(path, "series"),
                          {{"@error_title", "error, " + path.at(0, "measure")}},
                          {{"steps", rows_of(path, {"label", "change", "series", "scheme", "options", "within"},
                                             {"step", "modes", "rate", "error", "certificate", "target", "cost_s_per_s"})}},
                          {}};
    Chart c{
        "cost and error of each step from the whole scene to the trimmed one", chart_of("trim.json", filling, Medium::page), true, {}, {}};
    c.twins.push_back({"trim.svg", chart_of("trim.json", filling, Medium::print)});
    s.charts.push_back(std::move(c));
    s.notes = {"Costs are processor time, median of models timed in turn. Errors are from the motion of the whole scene."};
    s.table = r.path;
    return s;
}

std::string finding_of_trim(const Results& r) {
    if (r.path.rows.empty()) return "";
    const std::size_t last = r.path.rows.size() - 1;
    const bool in_decibels = r.path.at(last, "measure").find("error") == std::string::npos;  // "relative L2 error, 0-50 ms"
    const double target = r.path.number(last, "target");
    const std::string scene = r.name.starts_with("trim ") ? r.name.substr(5) : r.name;
    const std::string tolerance = in_decibels ? fmt::format("{:g} dB", target) : fmt::format("{:g} %", 100 * target);
    if (r.path.at(last, "within") != "yes") return fmt::format("No model of {} within {} was found", scene, tolerance);
    return fmt::format("{} within {}: the trimmed model costs {:.2g} times less than the whole scene as published", scene, tolerance,
                       r.path.number(0, "cost_s_per_s") / r.path.number(last, "cost_s_per_s"));
}

Section needs_section(const Results& r) {
    Section s{"needs", "What each part is needed for"};
    s.notes = {"Error and saving of the whole scene without the part alone. A part is needed where that error is beyond the tolerance."};
    s.table = r.needs;
    return s;
}

}  // namespace jvari::bench::report
