// What becomes of each scheme over a plane of two keys (maps.csv), with the refined boundaries and theory's (boundaries.csv).
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/report/page_sections.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;
using Words = std::vector<std::pair<std::string, std::string>>;

// "barrier 0 stiffness [N/m^exponent]" of "string.0.barrier.0.stiffness"
std::string with_unit(const std::string& key) {
    constexpr std::pair<const char*, const char*> units[] = {{"rate", "Hz"},
                                                             {"stiffness", "N/m^exponent"},
                                                             {"stiffness_density", "N/m^(exponent+1)"},
                                                             {"tension", "N"},
                                                             {"amplitude", "m"},
                                                             {"linear_density", "kg/m"},
                                                             {"bending_stiffness", "N m^2"},
                                                             {"length", "m"},
                                                             {"position", "m"},
                                                             {"height", "m"},
                                                             {"width", "m"},
                                                             {"damping", "kg/s"},
                                                             {"duration", "s"},
                                                             {"contact_loss", "s/m"},
                                                             {"sigma0", "1/s"}};
    const std::string last = key.substr(key.rfind('.') + 1);
    std::string text = key.starts_with("string.0.") ? key.substr(9) : key;
    std::replace(text.begin(), text.end(), '.', ' ');
    for (const auto& [name, unit] : units)
        if (last == name) text += std::string(" [") + unit + "]";
    return text;
}

// A logarithmic axis where all values are positive and span more than five to one; names where they are no numbers.
void add_axis(Words& words, const store::Table& t, const std::string& which) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    bool numbers = true;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const double x = t.number(i, which);
        numbers = numbers && !std::isnan(x);
        least = std::fmin(least, x);
        most = std::fmax(most, x);
    }
    words.emplace_back("@type_" + which, numbers ? "quantitative" : "ordinal");
    words.emplace_back("@scale_" + which, !numbers ? "point" : least > 0 && most > 5 * least ? "log" : "linear");
    words.emplace_back("@format_" + which, most >= 1e6 || (least > 0 && least < 1e-3) ? "~e" : "~r");
    words.emplace_back("@title_" + which, with_unit(t.at(0, which + "_key")));
}

struct Axes {
    bool x, y;  // of numbers
};

Json rows_json(const store::Table& cells, const store::Table& boundaries, Axes numbers) {
    Json rows = Json::array();
    const auto place = [](const store::Table& t, std::size_t i, const char* which, bool number) {
        return number ? Json(t.number(i, which)) : Json(t.at(i, which));
    };
    for (std::size_t i = 0; i < cells.rows.size(); ++i)
        rows.push_back({{"kind", "cell"},
                        {"series", cells.at(i, "series")},
                        {"x", place(cells, i, "x", numbers.x)},
                        {"y", place(cells, i, "y", numbers.y)},
                        {"outcome", cells.at(i, "outcome")},
                        {"detail", cells.at(i, "detail")}});
    for (std::size_t i = 0; numbers.x && i < boundaries.rows.size(); ++i) {
        const double low = boundaries.number(i, "x_low"), high = boundaries.number(i, "x_high");
        rows.push_back({{"kind", "boundary"},
                        {"series", boundaries.at(i, "series")},
                        {"x", low > 0 && high > 0 ? std::sqrt(low * high) : 0.5 * (low + high)},
                        {"y", place(boundaries, i, "y", numbers.y)},
                        {"between", boundaries.at(i, "between")},
                        {"theory", boundaries.number(i, "theory")}});
    }
    return rows;
}

Json on_frame(const std::string& spec) {  // a linear axis need not begin at zero, and names have no format
    Json chart = Json::parse(spec);
    for (const char* axis : {"x", "y"}) {
        Json& channel = chart["encoding"][axis];
        if (channel["type"] == "ordinal") channel["axis"].erase("format");
        else channel["scale"].update({{"nice", false}, {"padding", 14}});
        if (channel["scale"]["type"] == "linear") channel["scale"]["zero"] = false;
    }
    return chart;
}

Json panels_of(Json chart) {         // for papers: every scheme side by side
    for (Json& p : chart["params"])  // a panel's own size is none of the picture's signals
        if (p.at("name") == "tile") p["expr"] = "max(6, min(26, 0.8 * min(200 / across, 150 / down)))";
    Json inner{{"width", 200}, {"height", 150}, {"encoding", chart.at("encoding")}, {"layer", chart.at("layer")}};
    for (const char* key : {"width", "height", "encoding", "layer", "transform"}) chart.erase(key);
    chart["facet"] = {{"field", "series"}, {"type", "nominal"}, {"title", nullptr}};
    chart["columns"] = 4;
    chart["spec"] = inner;
    return chart;
}

Chart map_chart(const std::string& name, const std::vector<std::string>& names, const store::Table& cells, const store::Table& boundaries) {
    const auto series = distinct(cells, "series");
    Filling f{name,
              cells.at(0, "scene"),
              {},
              {},
              {},
              {{"series_field", json_text(series.front())},
               {"across", std::to_string(distinct(cells, "x").size())},
               {"down", std::to_string(distinct(cells, "y").size())}}};
    add_axis(f.words, cells, "x");
    add_axis(f.words, cells, "y");
    const auto of_numbers = [&f](const char* type) {
        return std::find(f.words.begin(), f.words.end(), std::pair<std::string, std::string>(type, "quantitative")) != f.words.end();
    };
    f.datasets = {{"rows", rows_json(cells, boundaries, {of_numbers("@type_x"), of_numbers("@type_y")}).dump()}};
    Chart c{"what becomes of a scheme: " + name, on_frame(chart_of("map.json", f, Medium::page)).dump(), false, {}, {}};
    Menu menu{name + ": scheme", "series_field", {}};
    for (const std::string& s : series) menu.choices.emplace_back(json_text(s), s);
    c.menus.push_back(std::move(menu));
    c.twins.push_back({"map-" + file_part(name, names) + ".svg", panels_of(on_frame(chart_of("map.json", f, Medium::print))).dump()});
    return c;
}
}  // namespace

Section map_section(const Results& r) {
    Section s{"maps", "Where methods fail"};
    if (r.maps.rows.empty()) return s;
    const auto names = distinct(r.maps, "map");
    for (const std::string& name : names)
        s.charts.push_back(map_chart(name, names, rows_where(r.maps, "map", name), rows_where(r.boundaries, "map", name)));
    s.notes = {"Each point is a run. Grey lines are boundaries found by bisection, broken ones what theory says."};
    if (!r.boundaries.rows.empty()) s.table = r.boundaries.only({r.boundaries.columns.begin() + 2, r.boundaries.columns.end()});
    return s;
}

}  // namespace jvari::bench::report
