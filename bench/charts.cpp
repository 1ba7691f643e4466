#include "bench/charts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/errors.hpp"
#include "bench/pareto.hpp"
#include "bench/rates.hpp"

namespace jvari {

namespace {
using Json = nlohmann::ordered_json;

// Okabe & Ito's palette without its yellow and black, which vanish on a light or a dark page; with six shapes 42 schemes stay apart.
constexpr const char* palette[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c8c8c"};
constexpr const char* shapes[] = {"circle", "square", "triangle-up", "diamond", "triangle-down", "cross"};
constexpr std::size_t direct_labels = 4;  // up to so many schemes every point says its rate, beyond only the front's

std::vector<std::string> schemes_of(const Table& cells) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < cells.rows.size(); ++i)
        if (cells.at(i, "status") != "refused" && std::find(names.begin(), names.end(), cells.at(i, "scheme")) == names.end())
            names.push_back(cells.at(i, "scheme"));
    return names;
}

// "x4" where all rates are multiples of the lowest, else "96k".
std::string rate_label(double rate, double lowest, bool multiples) {
    if (std::isnan(rate)) return "";
    if (multiples) return fmt::format("\u00d7{}", std::lround(rate / lowest));
    return fmt::format("{:.4g}k", rate / 1000);
}

double floor_of(const WorkPrecision& w, const std::string& column) {
    for (const auto& [name, value] : w.floors)
        if (name == column) return value;
    return std::nan("");
}

Json cells_json(const WorkPrecision& w) {
    const Table& t = w.cells;
    double lowest = HUGE_VAL;
    for (std::size_t i = 0; i < t.rows.size(); ++i) lowest = std::fmin(lowest, t.number(i, "rate"));
    bool multiples = true;
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (const double rate = t.number(i, "rate"); !std::isnan(rate)) multiples = multiples && whole_multiple(rate, lowest);
    Json rows = Json::array();
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        if (t.at(i, "status") == "refused") continue;  // it has neither cost nor error: the table says why
        Json j{{"scheme", t.at(i, "scheme")},
               {"modes", t.number(i, "modes")},
               {"status", t.at(i, "status")},
               {"reason", t.at(i, "reason")},
               {"label", rate_label(t.number(i, "rate"), lowest, multiples)},
               {"below", t.at(i, "below_floor")}};
        for (const auto* axes : {&w.errors, &w.costs})
            for (const Axis& a : *axes) j[a.column] = t.number(i, a.column);  // not finite: null
        if (!j.contains("rate")) j["rate"] = t.number(i, "rate");
        rows.push_back(std::move(j));
    }
    return rows;
}

// The front of every choice of error and cost, decided here and not in the page.
Json fronts_json(const WorkPrecision& w) {
    const Table& t = w.cells;
    Json rows = Json::array();
    for (const Axis& error : w.errors)
        for (const Axis& cost : w.costs) {
            const bool clock = cost.column == "cost_s_per_s" || cost.column == "ns_per_step";
            std::vector<Point> points;
            for (std::size_t i = 0; i < t.rows.size(); ++i) {
                const double c = t.at(i, "status") == "ok" ? t.number(i, cost.column) : std::nan(""), median = t.number(i, "cost_s_per_s");
                const double lower = clock ? t.number(i, "cost_lower") / median : 1, upper = clock ? t.number(i, "cost_upper") / median : 1;
                const double e = t.number(i, error.column);
                points.push_back({c, c * lower, c * upper, std::isnan(e) ? e : std::fmax(e, floor_of(w, error.column))});
            }
            const auto front = pareto_front(points);
            for (std::size_t i = 0; i < front.size(); ++i)
                if (front[i])
                    rows.push_back({{"error", error.column},
                                    {"cost", cost.column},
                                    {"x", points[i].cost},
                                    {"y", t.number(i, error.column)},
                                    {"scheme", t.at(i, "scheme")},
                                    {"rate", t.number(i, "rate")}});
        }
    return rows;
}

Json titles_json(const std::vector<Axis>& axes) {
    Json titles = Json::object();
    for (const Axis& a : axes) titles[a.column] = a.title;
    return titles;
}

// Decades are labelled; on an axis of less than three decades 2 and 5 as well.
Json axis(const char* field) {
    const std::string label = fmt::format(
        "round(pow(10, log(datum.value)/LN10 - floor(log(datum.value)/LN10 + 1e-9))) == 1 || "
        "(domain('{0}')[1]/domain('{0}')[0] < 1000 && "
        "indexof([2, 5], round(pow(10, log(datum.value)/LN10 - floor(log(datum.value)/LN10 + 1e-9)))) >= 0) ? "
        "(datum.value < 1e-3 || datum.value >= 1e6 ? format(datum.value, '~e') : format(datum.value, ',~r')) : ''",
        field);
    return {{"field", field},
            {"type", "quantitative"},
            {"scale", {{"type", "log"}, {"nice", false}, {"padding", 36}}},
            {"axis", {{"title", nullptr}, {"labelExpr", label}, {"labelOverlap", true}}}};
}
}  // namespace

std::string work_precision_spec(const WorkPrecision& w) {
    const auto schemes = schemes_of(w.cells);
    Json colours = Json::array(), marks = Json::array(), floors = Json::object();
    for (std::size_t i = 0; i < schemes.size(); ++i) {
        colours.push_back(palette[i % std::size(palette)]);
        marks.push_back(shapes[i % std::size(shapes)]);
    }
    for (const Axis& e : w.errors)
        if (const double f = floor_of(w, e.column); f > 0 && std::isfinite(f)) floors[e.column] = f;
    const std::string error = w.errors.empty() ? "" : w.errors.front().column, cost = w.costs.empty() ? "" : w.costs.front().column;

    const Json x = axis("x"), y = axis("y");
    const Json legend = schemes.size() > 1 ? Json{{"title", nullptr},
                                                  {"orient", w.wide ? "right" : "bottom"},
                                                  {"columns", w.wide ? 1 : 3},
                                                  {"labelLimit", 260},
                                                  {"symbolSize", 90}}
                                           : Json(nullptr);
    const Json colour{{"field", "scheme"}, {"type", "nominal"}, {"scale", {{"domain", schemes}, {"range", colours}}}, {"legend", legend}};
    const Json shape{{"field", "scheme"}, {"type", "nominal"}, {"scale", {{"domain", schemes}, {"range", marks}}}, {"legend", legend}};
    const Json faint{{"condition", {{"param", "pick"}, {"value", 1}}}, {"value", 0.12}};
    const Json placed =
        Json::array({{{"calculate", "datum[cost_field]"}, {"as", "x"}}, {{"calculate", "datum[error_field]"}, {"as", "y"}}});
    const auto where = [&placed](const char* condition) {
        Json steps = placed;
        steps.push_back({{"filter", condition}});
        return steps;
    };
    constexpr const char* sound = "isValid(datum.x) && isValid(datum.y) && datum.x > 0 && datum.y > 0 && datum.status == 'ok'";
    const Json tooltip = Json::array({{{"field", "scheme"}},
                                      {{"field", "rate"}, {"title", "rate [Hz]"}, {"format", ",~f"}},
                                      {{"field", "modes"}},
                                      {{"field", "y"}, {"title", "error"}, {"format", ".3e"}},
                                      {{"field", "x"}, {"title", "cost"}, {"format", ".3~s"}},
                                      {{"field", "status"}},
                                      {{"field", "reason"}},
                                      {{"field", "below"}, {"title", "tie: below the noise floor in"}}});

    Json layers = Json::array();
    // the noise floor of the chosen error, from its level down to the lower edge
    constexpr const char* level = "isValid(floors[error_field]) ? clamp(scale('y', floors[error_field]), 0, height) : height";
    layers.push_back({{"data", {{"values", Json::array({Json::object()})}}},
                      {"mark",
                       {{"type", "rect"},
                        {"x", 0},
                        {"x2", {{"expr", "width"}}},
                        {"y", {{"expr", level}}},
                        {"y2", {{"expr", "height"}}},
                        {"color", "#888"},
                        {"opacity", 0.18},
                        {"tooltip", nullptr}}}});
    layers.push_back({{"data", {{"values", Json::array({Json::object()})}}},
                      {"mark",
                       {{"type", "text"},
                        {"x", 6},
                        {"y", {{"expr", level}}},
                        {"dy", 10},
                        {"align", "left"},
                        {"fontSize", 10},
                        {"opacity", 0.75},
                        {"text", {{"expr", std::string("(") + level + ") < height - 14 ? 'noise floor' : ''"}}}}}});
    layers.push_back({{"data", {{"name", "fronts"}}},
                      {"transform", Json::array({{{"filter", "datum.error == error_field && datum.cost == cost_field && datum.y > 0"}}})},
                      {"mark",
                       {{"type", "line"},
                        {"interpolate", "linear"},
                        {"strokeWidth", 9},
                        {"opacity", 0.28},
                        {"color", "#888"},
                        {"strokeCap", "round"},
                        {"strokeJoin", "round"}}},
                      {"encoding", {{"x", x}, {"y", y}, {"order", {{"field", "x"}}}}}});
    layers.push_back({{"transform", where(sound)},
                      {"mark", {{"type", "line"}, {"strokeWidth", 1.6}}},
                      {"encoding", {{"x", x}, {"y", y}, {"color", colour}, {"order", {{"field", "rate"}}}, {"opacity", faint}}}});
    layers.push_back(
        {{"transform", where(sound)},
         {"mark", {{"type", "point"}, {"filled", true}, {"size", 75}}},
         {"params",
          Json::array({{{"name", "pick"}, {"select", {{"type", "point"}, {"fields", Json::array({"scheme"})}}}, {"bind", "legend"}}})},
         {"encoding", {{"x", x}, {"y", y}, {"color", colour}, {"shape", shape}, {"opacity", faint}, {"tooltip", tooltip}}}});
    Json labelled = where(sound);
    if (schemes.size() > direct_labels) {
        labelled.push_back({{"lookup", "key"},
                            {"from", {{"data", {{"name", "fronts"}}}, {"key", "key"}, {"fields", Json::array({"key"})}}},
                            {"as", Json::array({"front"})}});
        labelled.insert(labelled.begin(),
                        Json{{"calculate", "error_field + '|' + cost_field + '|' + datum.scheme + '|' + datum.rate"}, {"as", "key"}});
        labelled.push_back({{"filter", "isValid(datum.front)"}});
    }
    layers.push_back({{"transform", labelled},
                      {"mark", {{"type", "text"}, {"align", "left"}, {"dx", 8}, {"dy", -7}, {"fontSize", 10}}},
                      {"encoding", {{"x", x}, {"y", y}, {"text", {{"field", "label"}}}, {"color", colour}, {"opacity", faint}}}});
    // a run that failed, or whose error is not finite, at the upper edge over its cost
    layers.push_back({{"transform", where("datum.x > 0 && (datum.status != 'ok' || !isValid(datum.y))")},
                      {"mark", {{"type", "text"}, {"text", "\u2715"}, {"fontSize", 14}, {"fontWeight", "bold"}, {"y", 8}}},
                      {"encoding", {{"x", x}, {"color", colour}, {"opacity", faint}, {"tooltip", tooltip}}}});
    // the names of the axes: upright, above and below the frame, and following the choice
    layers.push_back({{"data", {{"values", Json::array({Json::object()})}}},
                      {"mark",
                       {{"type", "text"},
                        {"x", 0},
                        {"y", -10},
                        {"align", "left"},
                        {"fontSize", 12},
                        {"fontWeight", "bold"},
                        {"text", {{"expr", "error_titles[error_field]"}}}}}});
    layers.push_back({{"data", {{"values", Json::array({Json::object()})}}},
                      {"mark",
                       {{"type", "text"},
                        {"x", {{"expr", "width"}}},
                        {"y", {{"expr", "height + 36"}}},
                        {"align", "right"},
                        {"fontSize", 12},
                        {"fontWeight", "bold"},
                        {"text", {{"expr", "cost_titles[cost_field]"}}}}}});

    Json fronts = fronts_json(w);
    for (Json& f : fronts)
        f["key"] = fmt::format("{}|{}|{}|{}", f["error"].get<std::string>(), f["cost"].get<std::string>(), f["scheme"].get<std::string>(),
                               f["rate"].is_null() ? "null" : fmt::format("{}", f["rate"].get<double>()));
    Json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"},
              {"title", {{"text", w.title}, {"subtitle", w.subtitle}, {"anchor", "start"}, {"offset", 26}, {"subtitlePadding", 5}}},
              {"width", w.wide ? Json("container") : Json(760)},
              {"height", 470},
              {"padding", 12},
              {"params", Json::array({{{"name", "error_field"}, {"value", error}},
                                      {{"name", "cost_field"}, {"value", cost}},
                                      {{"name", "floors"}, {"value", floors}},
                                      {{"name", "error_titles"}, {"value", titles_json(w.errors)}},
                                      {{"name", "cost_titles"}, {"value", titles_json(w.costs)}}})},
              {"datasets", {{"cells", cells_json(w)}, {"fronts", fronts}}},
              {"data", {{"name", "cells"}}},
              {"layer", layers},
              {"config",
               {{"font", "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif"},
                {"view", {{"stroke", nullptr}}},
                {"axis", {{"gridOpacity", 0.45}, {"domainOpacity", 0.6}, {"labelFontSize", 11}}},
                {"title", {{"fontSize", 16}, {"subtitleFontSize", 12}}},
                {"legend", {{"labelFontSize", 11}, {"offset", w.wide ? 14 : 34}}}}}};
    if (!w.wide) spec["background"] = "white";
    return spec.dump();
}

std::vector<Axis> error_axes(const Table& cells, const std::vector<std::string>& taps, const std::string& first) {
    std::vector<Axis> axes;
    const auto add = [&](const std::string& column, const std::string& title) {
        for (std::size_t i = 0; i < cells.rows.size(); ++i)
            if (std::isfinite(cells.number(i, column))) {
                axes.insert(column == first ? axes.begin() : axes.end(), Axis{column, title});
                return;
            }
    };
    for (const std::string& tap : taps)
        for (const Measure& m : measures())
            if (m.less_is_better) add(m.column + (tap.empty() ? "" : "_" + tap), m.title + (tap.empty() ? "" : ", tap " + tap));
    return axes;
}

std::vector<Axis> cost_axes() {
    return {{"cost_s_per_s", "computing time per second of sound [s/s]"},
            {"ns_per_step", "time per step [ns]"},
            {"rate", "sample rate [Hz]"},
            {"dofs", "state carried [doubles]"}};
}

}  // namespace jvari
