// Cost across, error up, layer upon layer: noise floor, front, lines, points, labels, failures, names of the axes.
#include "bench/report/charts.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/report/chart_data.hpp"
#include "bench/report/identity.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;

constexpr double least_span = 3.1622776601683795;  // of the axis of errors: half a decade, so that no noise is blown up

struct Encodings {
    Json x, y, colour, shape, dash, faint;
    Json of_point, of_failure;  // what hovering shows
    std::size_t series;
};

// Decades are labelled; on an axis of less than three decades 2 and 5 as well. `number`: how a labelled value is written.
Json axis(const char* field, const std::string& number) {
    constexpr const char* digit = "round(pow(10, log(datum.value)/LN10 - floor(log(datum.value)/LN10 + 1e-9)))";
    const std::string label = fmt::format(
        "{1} == 1 || (domain('{0}')[1]/domain('{0}')[0] < 1000 && indexof([2, 5], {1}) >= 0) ? ({2}) : ''", field, digit, number);
    return {{"field", field},
            {"type", "quantitative"},
            {"scale", {{"type", "log"}, {"nice", false}, {"padding", 36}}},
            {"axis", {{"title", nullptr}, {"labelExpr", label}, {"labelOverlap", true}}}};
}

Json column(const char* field, const char* title, const char* format = nullptr) {
    Json j{{"field", field}, {"title", title}};
    if (format) j["format"] = format;
    return j;
}

Encodings encodings_of(const WorkPrecision& w) {
    const auto series = drawn_series(w.cells);
    const std::string plain = "datum.value < 1e-3 || datum.value >= 1e6 ? format(datum.value, '~e') : format(datum.value, ',~r')";
    const std::string time = "datum.value < 1 ? format(1000*datum.value, ',~r') + ' ms' : format(datum.value, ',~r') + ' s'";
    return {axis("x", fmt::format("cost_field == 'cost_s_per_s' ? ({}) : ({})", time, plain)),
            axis("y", fmt::format("substring(error_field, 0, 9) == 'error_l2_' ? format(100*datum.value, ',~r') + ' %' : ({})", plain)),
            Json::parse(colour_of_series(series)),
            Json::parse(shape_of_series(series)),
            Json::parse(dash_of_series(series)),
            {{"condition", {{"param", "pick"}, {"value", 1}}}, {"value", 0.1}},
            Json::array({column("series", "scheme"), column("label", "rate"), column("modes", "modes"), column("error_text", "error"),
                         column("x", "cost", ",.3~r"), column("spread", "its quartiles"), column("below", "below floor"),
                         column("flags", "not to be trusted")}),
            Json::array({column("series", "scheme"), column("label", "rate"), column("modes", "modes"), column("x", "cost", ",.3~r"),
                         column("reason", "reason")}),
            series.size()};
}

Json chosen(const char* condition) {  // x and y of the columns that are chosen, then the rows that satisfy the condition
    return Json::array(
        {{{"filter", "datum.problem == problem_field && (!length(main_series) || indexof(main_series, datum.series) >= 0)"}},
         {{"calculate", "datum[cost_field] * (cost_field == 'rate' ? 1e-3 : 1)"}, {"as", "x"}},
         {{"calculate", "cost_field == 'cost_s_per_s' || cost_field == 'ns_per_step'"}, {"as", "timed"}},
         {{"calculate", "datum.timed ? datum.x * datum.quartile_lower : null"}, {"as", "from"}},
         {{"calculate", "datum.timed ? datum.x * datum.quartile_upper : null"}, {"as", "to"}},
         {{"calculate", "datum.timed && isValid(datum.from) ? format(datum.from, ',.3~r') + ' to ' + format(datum.to, ',.3~r') : ''"},
          {"as", "spread"}},
         {{"calculate", "datum[error_field]"}, {"as", "y"}},
         {{"calculate", "(indexof(split(datum.at_most, ' '), error_field) < 0 ? '' : '\u2264 ') + format(datum.y, '.3e')"},
          {"as", "error_text"}},
         {{"filter", condition}}});
}
constexpr const char* sound = "isValid(datum.x) && isValid(datum.y) && datum.x > 0 && datum.y > 0 && datum.status == 'ok'";

Json once(Json mark) {  // a mark without rows
    return {{"data", {{"values", Json::array({Json::object()})}}}, {"mark", std::move(mark)}, {"encoding", Json::object()}};
}

// From the level of what limits the chosen error down to the lower edge.
void add_band(Json& layers, const std::string& field, const char* name, const char* colour, double opacity) {
    const std::string known = fmt::format("bands[problem_field + '|' + error_field]{}", field);
    const std::string level =
        fmt::format("bands[problem_field + '|' + error_field] && isValid({0}) ? clamp(scale('y', {0}), 0, height) : height", known);
    layers.push_back(once({{"type", "rect"},
                           {"x", 0},
                           {"x2", {{"expr", "width"}}},
                           {"y", {{"expr", level}}},
                           {"y2", {{"expr", "height"}}},
                           {"color", colour},
                           {"opacity", opacity},
                           {"tooltip", nullptr}}));
    layers.push_back(once({{"type", "text"},
                           {"x", 6},
                           {"y", {{"expr", level}}},
                           {"dy", 10},
                           {"align", "left"},
                           {"fontSize", 10},
                           {"opacity", 0.75},
                           {"text", {{"expr", fmt::format("({}) < height - 14 ? '{}' : ''", level, name)}}}}));
}

void add_front(Json& layers, const Encodings& e) {
    for (const auto& [width, colour] : {std::pair(10, front_edge.light), std::pair(7, front_track.light)})
        layers.push_back(
            {{"data", {{"name", "fronts"}}},
             {"transform",
              Json::array(
                  {{{"filter", "datum.problem == problem_field && datum.error == error_field && datum.cost == cost_field && datum.y > 0"}},
                   {{"calculate", "datum.x * (cost_field == 'rate' ? 1e-3 : 1)"}, {"as", "x"}}})},
             {"mark", {{"type", "line"}, {"strokeWidth", width}, {"color", colour}, {"strokeCap", "round"}, {"strokeJoin", "round"}}},
             {"encoding", {{"x", e.x}, {"y", e.y}, {"order", {{"field", "x"}}}, {"detail", {{"field", "machine"}}}}}});
}

Json line_of(const Encodings& e, const char* condition, double width) {
    return {{"transform", chosen(fmt::format("{} && {}", sound, condition).c_str())},
            {"mark", {{"type", "line"}, {"strokeWidth", width}}},
            {"encoding",
             {{"x", e.x}, {"y", e.y}, {"color", e.colour}, {"strokeDash", e.dash}, {"order", {{"field", "order"}}}, {"opacity", e.faint}}}};
}

void add_schemes(Json& layers, const Encodings& e, Medium medium) {
    Json from = e.x;
    from["field"] = "from";
    layers.push_back({{"transform", chosen(fmt::format("{} && datum.from > 0 && datum.to > 0", sound).c_str())},
                      {"mark", {{"type", "rule"}, {"strokeWidth", 1}}},
                      {"encoding", {{"x", from}, {"x2", {{"field", "to"}}}, {"y", e.y}, {"color", e.colour}, {"opacity", e.faint}}}});
    layers.push_back(line_of(e, "datum.control", 0.8));
    layers.push_back(line_of(e, "!datum.control", 1.8));
    const auto points = [&e](const char* condition, Json mark) {
        mark["type"] = "point";
        return Json{{"transform", chosen(fmt::format("{} && {}", sound, condition).c_str())},
                    {"mark", mark},
                    {"encoding",
                     {{"x", e.x},
                      {"y", e.y},
                      {"color", e.colour},
                      {"shape", e.shape},
                      {"size", {{"condition", {{"test", "datum.control"}, {"value", 30}}}, {"value", 75}}},
                      {"opacity", e.faint},
                      {"tooltip", e.of_point}}}};
    };
    Json trusted = points("datum.flags == ''", {{"filled", true}});
    if (Json& legend = trusted["encoding"]["color"]["legend"]; legend.is_object()) {
        legend["labelExpr"] = "replace(replace(datum.label, ' compliance=matched', ', matched'), ' compliance=own', ', as published')";
        if (medium == Medium::page) legend["values"] = {{"expr", "main_series"}};
    }
    trusted["params"] = Json::array(
        {{{"name", "pick"}, {"select", {{"type", "point"}, {"fields", Json::array({"series"})}, {"toggle", "true"}}}, {"bind", "legend"}}});
    layers.push_back(std::move(trusted));
    layers.push_back(points("datum.flags != ''", {{"filled", false}, {"strokeWidth", 1.6}}));  // hollow: not to be trusted
}

// For papers: rates along the front, and the name of each scheme at its dearest point there.
void add_front_labels(Json& layers, const Encodings& e) {
    Json labelled = chosen(sound);
    labelled.push_back(
        {{"calculate", "problem_field + '|' + error_field + '|' + cost_field + '|' + datum.series + '|' + datum.rate + '|' + datum.modes"},
         {"as", "key"}});
    labelled.push_back({{"lookup", "key"},
                        {"from", {{"data", {{"name", "fronts"}}}, {"key", "key"}, {"fields", Json::array({"key", "name"})}}},
                        {"as", Json::array({"front", "name"})}});
    labelled.push_back({{"filter", "isValid(datum.front) && !datum.control"}});
    labelled.push_back({{"calculate", "(datum.name && width > 500 ? datum.name + ', ' : '') + datum.label"}, {"as", "text"}});
    layers.push_back({{"transform", labelled},
                      {"mark", {{"type", "text"}, {"align", "left"}, {"dx", 8}, {"dy", -7}, {"fontSize", 10}}},
                      {"encoding", {{"x", e.x}, {"y", e.y}, {"text", {{"field", "text"}}}, {"opacity", e.faint}}}});
}

// Names at the ends of lines, where the page has found room for them.
void add_line_labels(Json& layers) {
    const auto pixels = [](const char* field) {
        return Json{{"field", field}, {"type", "quantitative"}, {"scale", nullptr}, {"axis", nullptr}};
    };
    layers.push_back({{"data", {{"name", "labels"}}},
                      {"mark", {{"type", "text"}, {"align", "left"}, {"fontSize", 11}}},
                      {"encoding", {{"x", pixels("x")}, {"y", pixels("y")}, {"text", {{"field", "text"}, {"type", "nominal"}}}}}});
}

void add_failures(Json& layers, const Encodings& e) {  // at the upper edge over their cost; what ended well is none, whatever it lacks
    layers.push_back({{"transform", chosen("datum.x > 0 && datum.status != 'ok'")},
                      {"mark", {{"type", "text"}, {"text", "\u2715"}, {"fontSize", 14}, {"fontWeight", "bold"}, {"y", 8}}},
                      {"encoding", {{"x", e.x}, {"color", e.colour}, {"opacity", e.faint}, {"tooltip", e.of_failure}}}});
}

// What the axis of errors cannot say: it spans half a decade at least, and where all errors lie below the noise floor there is nothing to
// read off.
void add_span_and_silence(Json& layers, const Encodings& e) {
    Json span = chosen(sound);
    span.push_back({{"aggregate", Json::array({{{"op", "min"}, {"field", "y"}, {"as", "least"}},
                                               {{"op", "max"}, {"field", "y"}, {"as", "most"}},
                                               {{"op", "min"}, {"field", "x"}, {"as", "x"}},
                                               {{"op", "count"}, {"as", "count"}}})}});
    for (const bool upper : {false, true}) {
        Json side = span;
        const std::string middle = "sqrt(datum.least * datum.most)";
        side.push_back({{"calculate", upper ? fmt::format("max(datum.most, {} * sqrt({}))", middle, least_span)
                                            : fmt::format("min(datum.least, {} / sqrt({}))", middle, least_span)},
                        {"as", "y"}});
        side.push_back({{"filter", "datum.count > 0"}});
        layers.push_back({{"transform", side},
                          {"mark", {{"type", "point"}, {"opacity", 0}, {"tooltip", nullptr}}},
                          {"encoding", {{"x", e.x}, {"y", e.y}}}});
    }
    const auto say = [&layers](Json rows, const char* filter, const char* text, int dy) {
        rows.push_back({{"filter", filter}});
        layers.push_back({{"transform", rows},
                          {"mark",
                           {{"type", "text"},
                            {"x", {{"expr", "width / 2"}}},
                            {"y", {{"expr", fmt::format("height / 2 + {}", dy)}}},
                            {"fontSize", 13},
                            {"fontWeight", "bold"},
                            {"text", {{"expr", text}}}}}});
    };
    say(span, "datum.count > 0 && bands[problem_field + '|' + error_field] && datum.most <= bands[problem_field + '|' + error_field].floor",
        "'All errors lie within the noise floor: no scheme is better than another by this measure.'", 0);
    Json without = chosen("datum.status == 'ok'");
    without.push_back({{"aggregate", Json::array({{{"op", "count"}, {"as", "all"}}, {{"op", "valid"}, {"field", "y"}, {"as", "with"}}})}});
    say(without, "datum.with == 0", "'These runs ended well and have no such error: choose another measure.'", 0);
}

void add_goals(Json& layers, const Encodings& e, Medium medium) {  // of computing time, which they are the cheapest by
    const Json goals{{"data", {{"name", "goals"}}},
                     {"transform", Json::array({{{"filter",
                                                  "datum.problem == problem_field && datum.error == error_field && "
                                                  "cost_field == 'cost_s_per_s'"}}})},
                     {"encoding", {{"y", e.y}}}};
    Json rule = goals, text = goals;
    rule["mark"] = {{"type", "rule"}, {"strokeDash", {2, 4}}, {"color", "#888"}};
    text["mark"] = {{"type", "text"},
                    {"x", {{"expr", "width - 6"}}},
                    {"dy", -6},
                    {"align", "right"},
                    {"fontSize", 10},
                    {"limit", {{"expr", "width - 12"}}},
                    {"opacity", {{"expr", "width < 500 ? 0 : 1"}}}};
    text["encoding"]["text"] = {{"field", "text"}};
    layers.push_back(std::move(rule));
    if (medium == Medium::print) layers.push_back(std::move(text));  // the page has its answers beside the chart
}

void add_real_time(Json& layers) {  // where a scheme takes a second for a second
    const std::string at = "scale('x', 1)", there = fmt::format("cost_field == 'cost_s_per_s' && {0} > 0 && {0} < width", at);
    layers.push_back(once({{"type", "rect"},
                           {"x", {{"expr", fmt::format("{} ? {} : 0", there, at)}}},
                           {"x2", {{"expr", fmt::format("{} ? {} + 1 : 0", there, at)}}},
                           {"y", 0},
                           {"y2", {{"expr", "height"}}},
                           {"color", "#888"},
                           {"tooltip", nullptr}}));
    layers.push_back(once({{"type", "text"},
                           {"x", {{"expr", fmt::format("{} ? {} : 0", there, at)}}},
                           {"y", {{"expr", "height - 6"}}},
                           {"dx", -5},
                           {"align", "right"},
                           {"fontSize", 10},
                           {"text", {{"expr", there + " ? 'real time' : ''"}}}}));
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
                           {"text", {{"expr", "width < 400 ? split(cost_titles[cost_field], ',')[0] : cost_titles[cost_field]"}}}}));
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
    Json bands = Json::object(), layers = Json::array();
    for (const Band& b : w.bands) {
        Json& levels = bands[b.problem + "|" + b.error] = Json::object();
        if (b.floor > 0 && std::isfinite(b.floor)) levels["floor"] = b.floor;
        if (b.certificate > 0 && std::isfinite(b.certificate)) levels["certificate"] = b.certificate;
    }
    add_band(layers, ".certificate", "the reference is certain to here", "#56b4e9", 0.16);
    add_band(layers, ".floor", "noise floor", "#888", 0.18);
    add_real_time(layers);
    add_goals(layers, e, w.medium);
    add_front(layers, e);
    add_schemes(layers, e, w.medium);
    if (w.medium == Medium::print) add_front_labels(layers, e);
    else add_line_labels(layers);
    add_failures(layers, e);
    add_span_and_silence(layers, e);
    add_axis_names(layers);

    const bool print = w.medium == Medium::print;
    const std::string shown = !w.problem.empty() || w.cells.rows.empty() ? w.problem : problem_of(w.cells, 0);
    Json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"}};
    if (print) spec["title"] = {{"text", w.title}, {"subtitle", w.subtitle}, {"anchor", "start"}, {"offset", 26}, {"subtitlePadding", 5}};
    spec.update({{"width", print ? Json(760) : Json("container")}, {"height", 470}, {"padding", 12}});
    if (print) spec["background"] = "white";
    spec["params"] = {parameter("measure_field", w.errors.empty() ? "" : w.errors.front().measure),
                      parameter("tap_field", w.errors.empty() ? "" : w.errors.front().tap),
                      {{"name", "error_field"}, {"expr", "measure_field + (tap_field == '' ? '' : '_' + tap_field)"}},
                      parameter("cost_field", w.costs.empty() ? "" : w.costs.front().column),
                      parameter("bands", bands),
                      parameter("problem_field", shown),
                      parameter("main_series", Json::array()),  // those that are drawn, chosen by the page; empty: all
                      parameter("error_titles", titles_json(w.errors)),
                      parameter("cost_titles", titles_json(w.costs))};
    spec["datasets"] = {{"cells", Json::parse(chart_cells(w))},
                        {"fronts", Json::parse(chart_fronts(w))},
                        {"goals", Json::array()},
                        {"labels", Json::array()}};
    for (const Goal& g : w.goals)
        spec["datasets"]["goals"].push_back({{"problem", g.problem}, {"error", g.error}, {"y", g.most}, {"text", g.text}});
    spec["data"] = {{"name", "cells"}};
    spec["layer"] = layers;
    spec["config"] = Json::parse(config_of(w.medium, e.series > 1));
    return spec.dump();
}

}  // namespace jvari::bench::report
