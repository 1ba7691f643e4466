// What becomes of each scheme over a plane of two keys (maps.csv): a tile per run, from half-way to its neighbour on the left to half-way
// to that on the right; with the refined boundaries and theory's (boundaries.csv).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "bench/report/identity.hpp"
#include "bench/report/sections/page_sections.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;
using Words = std::vector<std::pair<std::string, std::string>>;

// An axis of a map. It is of numbers where all are some, and logarithmic where all are positive and span more than five to one.
struct MapAxis {
    bool numbers = true, logarithmic = false;
    std::vector<double> places;  // distinct, from the least on
    std::string format, title;

    double on_scale(double x) const { return logarithmic ? std::log(x) : x; }
    double at(double scaled) const { return logarithmic ? std::exp(scaled) : scaled; }
    // The edges of the tile at x.
    std::pair<double, double> around(double x) const {
        const auto k = static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), x) - places.begin());
        const auto step = [this](std::size_t i) { return on_scale(places[i + 1]) - on_scale(places[i]); };
        const bool alone = places.size() < 2;
        const double before = alone ? 1 : step(k == 0 ? 0 : k - 1), after = alone ? 1 : step(k + 1 == places.size() ? k - 1 : k);
        return {at(on_scale(x) - 0.5 * before), at(on_scale(x) + 0.5 * after)};
    }
};

MapAxis axis_of(const store::Table& t, const std::string& which) {
    MapAxis axis;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        const double x = t.number(i, which);
        axis.numbers = axis.numbers && !std::isnan(x);
        if (!std::isnan(x)) axis.places.push_back(x);
    }
    std::sort(axis.places.begin(), axis.places.end());
    axis.places.erase(std::unique(axis.places.begin(), axis.places.end()), axis.places.end());
    const double least = axis.places.empty() ? 0 : axis.places.front(), most = axis.places.empty() ? 0 : axis.places.back();
    axis.logarithmic = axis.numbers && least > 0 && most > 5 * least;
    axis.format = most >= 1e6 || (least > 0 && least < 1e-3) ? "~e" : "~r";
    axis.title = with_unit(t.at(0, which + "_key"));
    return axis;
}

void add_words(Words& words, const MapAxis& axis, const std::string& which) {
    words.emplace_back("@type_" + which, axis.numbers ? "quantitative" : "ordinal");
    words.emplace_back("@scale_" + which, !axis.numbers ? "band" : axis.logarithmic ? "log" : "linear");
    words.emplace_back("@format_" + which, axis.format);
    words.emplace_back("@title_" + which, axis.title);
}

Json rows_json(const store::Table& cells, const store::Table& boundaries, const MapAxis& x, const MapAxis& y) {
    Json rows = Json::array();
    const auto place = [](const store::Table& t, std::size_t i, const char* which, const MapAxis& axis) {
        return axis.numbers ? Json(t.number(i, which)) : Json(t.at(i, which));
    };
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {
        Json& row = rows.emplace_back(Json{{"kind", "cell"},
                                           {"series", cells.at(i, "series")},
                                           {"x", place(cells, i, "x", x)},
                                           {"y", place(cells, i, "y", y)},
                                           {"outcome", cells.at(i, "outcome")},
                                           {"detail", cells.at(i, "detail")}});
        if (x.numbers) std::tie(row["left"], row["right"]) = x.around(cells.number(i, "x"));
        if (y.numbers) std::tie(row["below"], row["above"]) = y.around(cells.number(i, "y"));
    }
    for (std::size_t i = 0; x.numbers && i < boundaries.rows.size(); ++i) {
        const double low = boundaries.number(i, "x_low"), high = boundaries.number(i, "x_high");
        rows.push_back({{"kind", "boundary"},
                        {"series", boundaries.at(i, "series")},
                        {"x", low > 0 && high > 0 ? std::sqrt(low * high) : 0.5 * (low + high)},
                        {"y", place(boundaries, i, "y", y)},
                        {"between", boundaries.at(i, "between")},
                        {"theory", boundaries.number(i, "theory")}});
    }
    return rows;
}

// Tiles from edge to edge; a linear axis need not begin at zero, and names have no format.
Json tiled(const std::string& spec, const MapAxis& x, const MapAxis& y) {
    Json chart = Json::parse(spec);
    Json& tile = chart["layer"][0]["encoding"];
    const auto add = [&](const char* channel, const MapAxis& axis, const char* from, const char* to) {
        Json& shared = chart["encoding"][channel];
        if (!axis.numbers) {
            shared["axis"].erase("format");
            shared["scale"].update({{"padding", 0}});
            return;
        }
        shared["scale"].update({{"nice", false}});
        if (!axis.logarithmic) shared["scale"]["zero"] = false;
        tile[channel] = {{"field", from}, {"type", "quantitative"}};
        tile[std::string(channel) + "2"] = {{"field", to}};
    };
    add("x", x, "left", "right");
    add("y", y, "below", "above");
    return chart;
}

Json panels_of(Json chart, const std::vector<std::string>& series) {  // for papers: every scheme side by side
    for (Json& p : chart["params"])                                   // a panel's own size is none of the picture's signals
        if (p.at("name") == "glyph") p["expr"] = "clamp(0.45 * min(230 / across, 140 / down), 3, 9)";
    Json inner{{"width", 230}, {"height", 140}, {"encoding", chart.at("encoding")}, {"layer", chart.at("layer")}};
    for (const char* key : {"width", "height", "encoding", "layer", "transform"}) chart.erase(key);
    chart["facet"] = {{"field", "series"},
                      {"type", "nominal"},
                      {"title", nullptr},
                      {"sort", series},
                      {"header", {{"labelFontSize", 9}, {"labelLimit", 400}}}};
    chart["columns"] = 4;
    chart["bounds"] = "flush";  // a name does not push panels apart
    chart["spacing"] = {{"row", 26}, {"column", 18}};
    chart["spec"] = inner;
    return chart;
}

Chart map_chart(const std::string& name, const std::vector<std::string>& names, const store::Table& cells, const store::Table& boundaries) {
    const auto series = in_order(distinct(cells, "series"));
    const MapAxis x = axis_of(cells, "x"), y = axis_of(cells, "y");
    Filling f{name,
              cells.at(0, "scene"),
              {},
              {},
              {},
              {{"series_field", json_text(series.front())},
               {"across", std::to_string(distinct(cells, "x").size())},
               {"down", std::to_string(distinct(cells, "y").size())}}};
    add_words(f.words, x, "x");
    add_words(f.words, y, "y");
    f.datasets = {{"rows", rows_json(cells, boundaries, x, y).dump()}};
    Chart c{"what becomes of a scheme: " + name, tiled(chart_of("map.json", f, Medium::page), x, y).dump(), false, {}, {}};
    Menu menu{name + ": scheme", "series_field", {}};
    for (const std::string& s : series) menu.choices.emplace_back(json_text(s), s);
    c.menus.push_back(std::move(menu));
    c.twins.push_back(
        {"map-" + file_part(name, names) + ".svg", panels_of(tiled(chart_of("map.json", f, Medium::print), x, y), series).dump()});
    return c;
}
}  // namespace

namespace {
struct Share {
    int sound = 0, runs = 0;
};
using Shares = std::map<std::string, std::map<std::string, Share>>;  // of each scheme on each map, of the runs that were not refused

Shares shares_of(const store::Table& maps) {
    Shares shares;
    for (std::size_t i = 0; i < maps.rows.size(); ++i) {
        if (maps.at(i, "outcome") == "refused") continue;
        Share& share = shares[maps.at(i, "series")][maps.at(i, "map")];
        ++share.runs;
        share.sound += maps.at(i, "outcome") == "sound";
    }
    return shares;
}
}  // namespace

Section overview_section(const Results& r) {
    Section s{"overview", "How often each scheme stays sound"};
    if (r.maps.rows.empty()) return s;
    Shares shares = shares_of(r.maps);
    s.table.columns = {"scheme", "map", "sound", "runs"};
    Json rows = Json::array();
    for (const std::string& series : in_order(distinct(r.maps, "series")))
        for (const std::string& name : distinct(r.maps, "map")) {
            const Share share = shares[series][name];
            if (share.runs == 0) continue;
            rows.push_back({{"series", series}, {"map", name}, {"share", 100.0 * share.sound / share.runs}, {"runs", share.runs}});
            s.table.rows.push_back({series, name, std::to_string(share.sound), std::to_string(share.runs)});
        }
    const auto filling = [&](const char* title) { return Filling{title, r.name, {}, {}, {{"rows", rows.dump()}}, {}}; };
    Chart c{"the share of sound runs of each scheme on each map", chart_of("overview.json", filling(""), Medium::page)};
    c.twins.push_back({"overview.svg", chart_of("overview.json", filling("Sound runs, per cent"), Medium::print)});
    s.charts.push_back(std::move(c));
    s.notes = {
        "Per cent of the runs of a map that end sound. Refused runs do not count; where nothing stands the scheme was not run on the map."};
    return s;
}

std::string finding_of_maps(const Results& r) {
    const Shares shares = shares_of(r.maps);
    if (shares.empty()) return "";
    const auto sound_maps = [](const auto& of) {
        return std::ranges::count_if(of.second, [](const auto& m) { return m.second.sound == m.second.runs; });
    };
    const auto best = std::ranges::max_element(shares, {}, sound_maps);
    const auto failing = std::ranges::count_if(shares, [&](const auto& of) { return sound_maps(of) < std::ssize(of.second); });
    return fmt::format("{} of {} schemes fail somewhere; {} stays sound on {} of its {} maps", failing, shares.size(), best->first,
                       sound_maps(*best), best->second.size());
}

Section map_section(const Results& r) {
    Section s{"maps", "Where methods fail"};
    if (r.maps.rows.empty()) return s;
    const auto names = distinct(r.maps, "map");
    for (const std::string& name : names)
        s.charts.push_back(map_chart(name, names, rows_where(r.maps, "map", name), rows_where(r.boundaries, "map", name)));
    s.notes = {
        "Each tile is a run; a white mark tells those that are not sound apart, for eyes that colour does not help. Solid lines are "
        "boundaries "
        "found by bisection, broken ones what theory says."};
    for (const std::string& motion : distinct(r.boundaries, "theory_holds_for"))
        if (!motion.empty()) s.notes.push_back("Theory is of " + motion + ".");
    if (!r.boundaries.rows.empty()) s.table = r.boundaries.only({r.boundaries.columns.begin() + 2, r.boundaries.columns.end()});
    return s;
}

}  // namespace jvari::bench::report
