#include "bench/report/chart_data.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/compare/bound.hpp"
#include "bench/compare/record/pareto.hpp"
#include "bench/report/identity.hpp"
#include "bench/study/errors.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;

// Where on its line: at which rate, and with how many modes where they differ along it or there is no rate.
std::string place_label(double rate, double modes, bool modes_differ) {
    const std::string text = std::isnan(modes) || !(modes_differ || std::isnan(rate)) ? "" : fmt::format("{:.0f} modes", modes);
    if (std::isnan(rate)) return text;
    return fmt::format("{}{}{:.4g} kHz", text, text.empty() ? "" : ", ", rate / 1000);
}

// Series of schemes with numbers of modes to choose, that have several.
std::set<std::string> of_several_modes(const store::Table& t) {
    std::map<std::string, std::set<std::string>> modes;
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (!(t.number(i, "fact_grid_intervals") > 0)) modes[problem_of(t, i) + "|" + series_of(t, i)].insert(t.at(i, "modes"));
    std::set<std::string> several;
    for (const auto& [series, all] : modes)
        if (all.size() > 1) several.insert(series);
    return several;
}
}  // namespace

const std::string& problem_of(const store::Table& cells, std::size_t row) {
    return cells.at(row, "problem");
}
const std::string& series_of(const store::Table& cells, std::size_t row) {
    return cells.at(row, cells.column("series") < 0 ? "scheme" : "series");
}

std::vector<std::string> drawn_series(const store::Table& cells) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < cells.rows.size(); ++i)
        if (cells.at(i, "status") != "refused" && std::find(names.begin(), names.end(), series_of(cells, i)) == names.end())
            names.push_back(series_of(cells, i));
    return names;
}

std::string chart_cells(const WorkPrecision& w) {
    const store::Table& t = w.cells;
    const auto names = drawn_series(t);
    const auto identities = identities_of(names);
    std::map<std::string, bool> control;
    for (std::size_t k = 0; k < names.size(); ++k) control[names[k]] = identities[k].control;
    Json rows = Json::array();
    const auto several = of_several_modes(t);
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        if (t.at(i, "status") == "refused") continue;  // it has neither cost nor error: the table says why
        const double rate = t.number(i, "rate"), modes = t.number(i, "modes");
        const std::string& problem = problem_of(t, i);
        const bool modes_differ = several.contains(problem + "|" + series_of(t, i));
        Json j{{"problem", problem},
               {"series", series_of(t, i)},
               {"scheme", t.at(i, "scheme")},
               {"rate", rate},
               {"modes", modes},
               {"order", std::isnan(rate) ? modes
                         : modes_differ   ? t.number(i, "cost_s_per_s")
                                          : rate},
               {"status", t.at(i, "status")},
               {"reason", t.at(i, "reason")},
               {"label", place_label(rate, modes, modes_differ)},
               {"control", control[series_of(t, i)]},
               {"flags", t.at(i, "flags")},
               {"below", t.at(i, "below_floor")}};
        const auto add = [&j](const std::string& column, double x) {  // not finite: null; seven digits are enough for a point
            j[column] = std::isfinite(x) ? store::number_of(fmt::format("{:.7g}", x)) : std::nan("");
        };
        std::string at_most;
        for (const Axis& a : w.errors) {
            const compare::Bound b = compare::bound_of(t, i, a.column);
            add(a.column, b.shown());
            if (b.says() == compare::Bound::Says::at_most || b.says() == compare::Bound::Says::unknown)
                at_most += (at_most.empty() ? "" : " ") + a.column;
        }
        for (const Axis& a : w.costs) add(a.column, t.number(i, a.column));
        if (!w.costs.empty() && t.number(i, "cost_s_per_s") > 0)  // quartiles, as parts of the median
            for (const char* side : {"lower", "upper"})
                add(std::string("quartile_") + side, t.number(i, std::string("cost_") + side) / t.number(i, "cost_s_per_s"));
        j["at_most"] = at_most;
        rows.push_back(std::move(j));
    }
    return rows.dump();
}

std::string chart_fronts(const WorkPrecision& w) {
    const store::Table& t = w.cells;
    Json rows = Json::array();
    store::Rows rivals = store::all_rows(t);
    std::erase_if(rivals, [&](std::size_t i) { return !compare::may_win(t, i, w.controls); });
    for (const store::Rows& problem : store::alike(t, rivals, {"problem"}))
        for (const Axis& error : w.errors)
            for (const Axis& cost : w.costs) {
                const auto front = compare::pareto_front(t, problem, error.column, cost.column);
                std::map<std::string, std::size_t> dearest;  // of each series, which is named there
                for (std::size_t k = 0; k < front.size(); ++k)
                    if (front[k])
                        if (const auto [at, first] = dearest.emplace(series_of(t, problem[k]), problem[k]);
                            !first && t.number(problem[k], cost.column) > t.number(at->second, cost.column))
                            at->second = problem[k];
                for (std::size_t k = 0; k < front.size(); ++k) {
                    if (!front[k]) continue;
                    const std::size_t i = problem[k];
                    const double rate = t.number(i, "rate");
                    const std::string key = fmt::format("{}|{}|{}|{}|{}|{}", problem_of(t, i), error.column, cost.column, series_of(t, i),
                                                        std::isnan(rate) ? "null" : fmt::format("{}", rate), t.at(i, "modes"));
                    rows.push_back({{"problem", problem_of(t, i)},
                                    {"machine", t.at(i, "machine")},  // a front is of one
                                    {"error", error.column},
                                    {"cost", cost.column},
                                    {"x", t.number(i, cost.column)},
                                    {"y", compare::bound_of(t, i, error.column).shown()},
                                    {"key", key},
                                    {"name", dearest.at(series_of(t, i)) == i ? series_of(t, i) : ""}});
                }
            }
    return rows.dump();
}

std::vector<Axis> error_axes(const store::Table& cells, const std::vector<std::string>& taps, const std::string& first) {
    std::vector<Axis> axes;
    for (const std::string& tap : taps)
        for (const study::Measure& m : study::measures()) {
            const Axis axis{m.column + (tap.empty() ? "" : "_" + tap), m.title + (tap.empty() ? "" : ", tap " + tap), m.column, tap};
            bool finite = false;
            for (std::size_t i = 0; i < cells.rows.size(); ++i) finite = finite || std::isfinite(cells.number(i, axis.column));
            if (m.less_is_better && finite) axes.insert(axis.column == first ? axes.begin() : axes.end(), axis);
        }
    return axes;
}

std::vector<Axis> cost_axes() {
    return {{"cost_s_per_s", "computing time for one second of sound, one core"},
            {"ns_per_step", "time per step [ns]"},
            {"worst_block_of_deadline", "worst block of 64 samples, as a fraction of its deadline"},
            {"rate", "sample rate [kHz]"},
            {"dofs", "state carried [doubles]"}};
}

}  // namespace jvari::bench::report
