// Cost across, error up, layer upon layer: noise floor, front, lines, points, labels, failures, names of the axes.
#include "bench/charts.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/chart_data.hpp"

namespace jvari {

namespace {
using Json = nlohmann::ordered_json;

// Okabe & Ito's palette without its yellow and black, which vanish on a light or a dark page; with six shapes 42 schemes stay apart.
constexpr const char* palette[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c8c8c"};
constexpr const char* shapes[] = {"circle", "square", "triangle-up", "diamond", "triangle-down", "cross"};
constexpr int dashes[][2] = {{1, 0}, {6, 3}, {2, 2}};  // the next each time round the palette
constexpr std::size_t direct_labels = 4;               // up to so many schemes every point says its rate, beyond only the front's

struct Encodings {
    Json x, y, colour, shape, dash, faint;
    Json of_point, of_failure;  // what hovering shows
    std::size_t schemes;
};

// Decades are labelled; on an axis of less than three decades 2 and 5 as well.
Json axis(const char* field) {
    constexpr const char* digit = "round(pow(10, log(datum.value)/LN10 - floor(log(datum.value)/LN10 + 1e-9)))";
    const std::string label = fmt::format(
        "{1} == 1 || (domain('{0}')[1]/domain('{0}')[0] < 1000 && indexof([2, 5], {1}) >= 0) ? "
        "(datum.value < 1e-3 || datum.value >= 1e6 ? format(datum.value, '~e') : format(datum.value, ',~r')) : ''",
        field, digit);
    return {{"field", field},
            {"type", "quantitative"},
            {"scale", {{"type", "log"}, {"nice", false}, {"padding", 36}}},
            {"axis", {{"title", nullptr}, {"labelExpr", label}, {"labelOverlap", true}}}};
}

Json by_scheme(const std::vector<std::string>& schemes, const Json& range, const Json& legend) {
    return {{"field", "scheme"}, {"type", "nominal"}, {"scale", {{"domain", schemes}, {"range", range}}}, {"legend", legend}};
}

Json column(const char* field, const char* title, const char* format = nullptr) {
    Json j{{"field", field}, {"title", title}};
    if (format) j["format"] = format;
    return j;
}

Encodings encodings_of(const WorkPrecision& w) {
    const auto schemes = drawn_schemes(w.cells);
    Json colours = Json::array(), marks = Json::array(), strokes = Json::array(), legend;
    for (std::size_t i = 0; i < schemes.size(); ++i) {
        const auto& dash = dashes[i / std::size(palette) % std::size(dashes)];
        colours.push_back(palette[i % std::size(palette)]);
        marks.push_back(shapes[i % std::size(shapes)]);
        strokes.push_back({dash[0], dash[1]});
    }
    if (schemes.size() > 1)
        legend = {{"title", nullptr},          {"orient", w.wide ? "right" : "bottom"},
                  {"columns", w.wide ? 1 : 2}, {"labelLimit", 600},
                  {"symbolSize", 90},          {"symbolStrokeWidth", 0}};
    return {axis("x"),
            axis("y"),
            by_scheme(schemes, colours, legend),
            by_scheme(schemes, marks, legend),
            by_scheme(schemes, strokes, legend),
            {{"condition", {{"param", "pick"}, {"value", 1}}}, {"value", 0.12}},
            Json::array({column("scheme", "scheme"), column("rate", "rate [Hz]", ",~f"), column("modes", "modes"),
                         column("y", "error", ".3e"), column("x", "cost", ",.3~r"), column("below", "below floor")}),
            Json::array({column("scheme", "scheme"), column("rate", "rate [Hz]", ",~f"), column("modes", "modes"),
                         column("x", "cost", ",.3~r"), column("reason", "reason")}),
            schemes.size()};
}

Json chosen(const char* condition) {  // x and y of the columns that are chosen, then the rows that satisfy the condition
    return Json::array(
        {{{"calculate", "datum[cost_field]"}, {"as", "x"}}, {{"calculate", "datum[error_field]"}, {"as", "y"}}, {{"filter", condition}}});
}
constexpr const char* sound = "isValid(datum.x) && isValid(datum.y) && datum.x > 0 && datum.y > 0 && datum.status == 'ok'";

Json once(Json mark) {  // a mark without rows
    return {{"data", {{"values", Json::array({Json::object()})}}}, {"mark", std::move(mark)}};
}

void add_floor(Json& layers) {  // from the level of the chosen error's noise floor down to the lower edge
    const std::string level = "isValid(floors[error_field]) ? clamp(scale('y', floors[error_field]), 0, height) : height";
    layers.push_back(once({{"type", "rect"},
                           {"x", 0},
                           {"x2", {{"expr", "width"}}},
                           {"y", {{"expr", level}}},
                           {"y2", {{"expr", "height"}}},
                           {"color", "#888"},
                           {"opacity", 0.18},
                           {"tooltip", nullptr}}));
    layers.push_back(once({{"type", "text"},
                           {"x", 6},
                           {"y", {{"expr", level}}},
                           {"dy", 10},
                           {"align", "left"},
                           {"fontSize", 10},
                           {"opacity", 0.75},
                           {"text", {{"expr", "(" + level + ") < height - 14 ? 'noise floor' : ''"}}}}));
}

void add_front(Json& layers, const Encodings& e) {
    layers.push_back(
        {{"data", {{"name", "fronts"}}},
         {"transform", Json::array({{{"filter", "datum.error == error_field && datum.cost == cost_field && datum.y > 0"}}})},
         {"mark",
          {{"type", "line"}, {"strokeWidth", 9}, {"opacity", 0.28}, {"color", "#888"}, {"strokeCap", "round"}, {"strokeJoin", "round"}}},
         {"encoding", {{"x", e.x}, {"y", e.y}, {"order", {{"field", "x"}}}}}});
}

void add_schemes(Json& layers, const Encodings& e) {
    layers.push_back(
        {{"transform", chosen(sound)},
         {"mark", {{"type", "line"}, {"strokeWidth", 1.6}}},
         {"encoding",
          {{"x", e.x}, {"y", e.y}, {"color", e.colour}, {"strokeDash", e.dash}, {"order", {{"field", "rate"}}}, {"opacity", e.faint}}}});
    layers.push_back(
        {{"transform", chosen(sound)},
         {"mark", {{"type", "point"}, {"filled", true}, {"size", 75}}},
         {"params",
          Json::array({{{"name", "pick"}, {"select", {{"type", "point"}, {"fields", Json::array({"scheme"})}}}, {"bind", "legend"}}})},
         {"encoding", {{"x", e.x}, {"y", e.y}, {"color", e.colour}, {"shape", e.shape}, {"opacity", e.faint}, {"tooltip", e.of_point}}}});
    Json labelled = chosen(sound);
    if (e.schemes > direct_labels) {
        labelled.push_back({{"calculate", "error_field + '|' + cost_field + '|' + datum.scheme + '|' + datum.rate"}, {"as", "key"}});
        labelled.push_back({{"lookup", "key"},
                            {"from", {{"data", {{"name", "fronts"}}}, {"key", "key"}, {"fields", Json::array({"key"})}}},
                            {"as", Json::array({"front"})}});
        labelled.push_back({{"filter", "isValid(datum.front)"}});
    }
    layers.push_back({{"transform", labelled},
                      {"mark", {{"type", "text"}, {"align", "left"}, {"dx", 8}, {"dy", -7}, {"fontSize", 10}}},
                      {"encoding", {{"x", e.x}, {"y", e.y}, {"text", {{"field", "label"}}}, {"color", e.colour}, {"opacity", e.faint}}}});
}

void add_failures(Json& layers, const Encodings& e) {  // at the upper edge over their cost, also those whose error is not finite
    layers.push_back({{"transform", chosen("datum.x > 0 && (datum.status != 'ok' || !isValid(datum.y))")},
                      {"mark", {{"type", "text"}, {"text", "\u2715"}, {"fontSize", 14}, {"fontWeight", "bold"}, {"y", 8}}},
                      {"encoding", {{"x", e.x}, {"color", e.colour}, {"opacity", e.faint}, {"tooltip", e.of_failure}}}});
}

void add_axis_names(Json& layers) {  // upright, above and below the frame, following the choice
    layers.push_back(once({{"type", "text"},
                           {"x", 0},
                           {"y", -10},
                           {"align", "left"},
                           {"fontSize", 12},
                           {"fontWeight", "bold"},
                           {"text", {{"expr", "error_titles[error_field]"}}}}));
    layers.push_back(once({{"type", "text"},
                           {"x", {{"expr", "width"}}},
                           {"y", {{"expr", "height + 36"}}},
                           {"align", "right"},
                           {"fontSize", 12},
                           {"fontWeight", "bold"},
                           {"text", {{"expr", "cost_titles[cost_field]"}}}}));
}

Json titles_json(const std::vector<Axis>& axes) {
    Json titles = Json::object();
    for (const Axis& a : axes) titles[a.column] = a.title;
    return titles;
}

Json parameter(const char* name, Json value) {
    return {{"name", name}, {"value", std::move(value)}};
}
}  // namespace

std::string work_precision_spec(const WorkPrecision& w) {
    const Encodings e = encodings_of(w);
    Json floors = Json::object(), layers = Json::array();
    for (const Axis& error : w.errors)
        if (const double f = floor_of(w, error.column); f > 0 && std::isfinite(f)) floors[error.column] = f;
    add_floor(layers);
    add_front(layers, e);
    add_schemes(layers, e);
    add_failures(layers, e);
    add_axis_names(layers);

    Json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"},
              {"title", {{"text", w.title}, {"subtitle", w.subtitle}, {"anchor", "start"}, {"offset", 26}, {"subtitlePadding", 5}}},
              {"width", w.wide ? Json("container") : Json(760)},
              {"height", 470},
              {"padding", 12}};
    if (!w.wide) spec["background"] = "white";
    spec["params"] = {parameter("error_field", w.errors.empty() ? "" : w.errors.front().column),
                      parameter("cost_field", w.costs.empty() ? "" : w.costs.front().column), parameter("floors", floors),
                      parameter("error_titles", titles_json(w.errors)), parameter("cost_titles", titles_json(w.costs))};
    spec["datasets"] = {{"cells", Json::parse(chart_cells(w))}, {"fronts", Json::parse(chart_fronts(w))}};
    spec["data"] = {{"name", "cells"}};
    spec["layer"] = layers;
    spec["config"] = {{"font", "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif"},
                      {"view", {{"stroke", nullptr}}},
                      {"axis", {{"gridOpacity", 0.45}, {"domainOpacity", 0.6}, {"labelFontSize", 11}}},
                      {"title", {{"fontSize", 16}, {"subtitleFontSize", 12}}},
                      {"legend", {{"labelFontSize", 11}, {"offset", w.wide ? 14 : 34}}}};
    return spec.dump();
}

}  // namespace jvari
