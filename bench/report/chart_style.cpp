#include "bench/report/chart_style.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/report/identity.hpp"
#include "bench/report/page_text.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;

template <class Style>
std::string encoding(const std::vector<std::string>& unordered, const std::string& field, Style style) {
    const std::vector<std::string> names = in_order(unordered);
    Json range = Json::array();
    for (const Identity& i : identities_of(names)) range.push_back(style(i));
    return Json{{"field", field},
                {"type", "nominal"},
                {"scale", {{"domain", names}, {"range", range}}},
                {"legend", names.size() > 1 ? Json{{"title", nullptr}} : Json()}}
        .dump();
}

Json filled(const Json& part, const Filling& f) {
    if (part.is_string()) {
        const std::string text = part;
        if (text == "@colour") return Json::parse(colour_of_series(f.series));
        if (text == "@shape") return Json::parse(shape_of_series(f.series));
        if (text == "@dash") return Json::parse(dash_of_series(f.series));
        for (const auto& [word, meaning] : f.words)
            if (text == word) return meaning;
        return part;
    }
    if (!part.is_structured()) return part;
    Json whole = part;
    for (Json& inner : whole) inner = filled(inner, f);
    return whole;
}
}  // namespace

std::string colour_of_series(const std::vector<std::string>& names, const std::string& field) {
    return encoding(names, field, [](const Identity& i) { return i.colour; });
}
std::string shape_of_series(const std::vector<std::string>& names, const std::string& field) {
    return encoding(names, field, [](const Identity& i) { return i.shape; });
}
std::string dash_of_series(const std::vector<std::string>& names, const std::string& field) {
    return encoding(names, field, [](const Identity& i) { return i.dash; });
}

std::string config_of(Medium medium, bool has_legend) {
    Json config{{"font", "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif"},
                {"view", {{"stroke", nullptr}}},
                {"axis", {{"gridOpacity", 0.45}, {"domainOpacity", 0.6}, {"labelFontSize", 11}}},
                {"title", {{"fontSize", 16}, {"subtitleFontSize", 12}}}};
    if (medium == Medium::print)
        config["legend"] = {{"labelFontSize", 11}, {"labelLimit", 600}, {"symbolSize", 90}, {"symbolStrokeWidth", 0}, {"symbolOpacity", 1}};
    if (medium == Medium::print && has_legend) config["legend"].update({{"orient", "bottom"}, {"columns", 2}, {"offset", 34}});
    return config.dump();
}

std::string chart_of(const char* template_file, const Filling& f, Medium medium) {
    Json spec = filled(Json::parse(page_text(template_file)), f);
    Json chart{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"}, {"padding", 12}};
    if (medium == Medium::print) {
        chart["title"] = {{"text", f.title}, {"subtitle", f.subtitle}, {"anchor", "start"}, {"offset", 26}, {"subtitlePadding", 5}};
        chart["background"] = "white";
    }
    if (spec.contains("layer") || spec.contains("mark")) chart["width"] = medium == Medium::print ? Json(760) : Json("container");
    for (const auto& [name, rows] : f.datasets) spec["datasets"][name] = Json::parse(rows);
    for (Json& p : spec["params"])
        for (const auto& [name, value] : f.values)
            if (p.at("name") == name) p["value"] = Json::parse(value);
    chart.update(spec);
    chart["config"] = Json::parse(config_of(medium, f.series.size() > 1));
    return chart.dump();
}

std::string rows_of(const store::Table& t, const std::vector<std::string>& texts, const std::vector<std::string>& numbers) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        Json& row = rows.emplace_back(Json::object());
        for (const std::string& name : texts) row[name] = t.at(i, name);
        for (const std::string& name : numbers) row[name] = t.number(i, name);
    }
    return rows.dump();
}

std::string json_text(const std::string& text) {
    return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace jvari::bench::report
