// Colours are Okabe & Ito's, apart from each other for the colour-blind; a letter says the same. Cells reach to the middles between
// points, of the axis as it is drawn.
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/map_tables.hpp"

namespace jvari {

namespace {
using Json = nlohmann::ordered_json;

struct Look {
    const char *colour, *letter;
};
Look look_of(Verdict v) {
    switch (v) {
        case Verdict::sound: return {"#d9efe7", "."};
        case Verdict::inaccurate: return {"#f0e442", "I"};
        case Verdict::adhesive: return {"#56b4e9", "A"};
        case Verdict::energy_gaining: return {"#cc79a7", "G"};
        case Verdict::not_converged: return {"#0072b2", "N"};
        case Verdict::diverged: return {"#d55e00", "D"};
        case Verdict::refused: return {"#bdbdbd", "R"};
    }
    return {"#ffffff", "?"};
}

std::string title_of(const std::string& key) {  // string.0.barrier.0.stiffness -> barrier stiffness
    std::string text;
    for (std::size_t at = 0; at < key.size();) {
        const std::size_t end = std::min(key.find('.', at), key.size());
        const std::string word = key.substr(at, end - at);
        if (word != "string" && word.find_first_not_of("0123456789") != std::string::npos) text += (text.empty() ? "" : " ") + word;
        at = end + 1;
    }
    return text == "rate" ? "rate [Hz]" : text;
}

std::string legend_text(Verdict v) {
    return std::string(look_of(v).letter) + "  " + name_of(v);
}

bool logarithmic(const MapAxis& a) {
    return !a.at.empty() && a.at.front() > 0 && a.at.back() >= 4 * a.at.front();
}

// Edges of the cell around the i-th value of an axis of numbers.
std::pair<double, double> edges(const MapAxis& a, std::size_t i) {
    const bool log = logarithmic(a);
    const auto to = [log](double x) { return log ? std::log(x) : x; };
    const auto from = [log](double x) { return log ? std::exp(x) : x; };
    const std::size_t n = a.at.size();
    if (n == 1) return {0.9 * a.at[0], 1.1 * a.at[0]};
    const double x = to(a.at[i]);
    const double below = i > 0 ? x - to(a.at[i - 1]) : to(a.at[1]) - x, above = i + 1 < n ? to(a.at[i + 1]) - x : below;
    return {from(x - 0.5 * below), from(x + 0.5 * above)};
}

std::string short_text(const std::string& value) {  // 1.0000000000000000e4 -> 1e+04, a word as it is
    const double x = number_of(value);
    if (std::isnan(x)) return value;
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", x);
    return text;
}
}  // namespace

std::string map_spec(const Map& map, const MapRun& run) {
    const bool numbers = !map.x.at.empty(), log = logarithmic(map.x);
    Json rows = Json::array();
    const std::string y_title = title_of(map.y.key);
    for (auto y = map.y.values.rbegin(); y != map.y.values.rend(); ++y) rows.push_back(short_text(*y));
    if (rows.empty()) rows.push_back("");

    std::vector<std::string> panels;
    std::map<std::string, Json> cells, lines;
    std::set<Verdict> seen;
    for (const JudgedPoint& p : run.points) {
        if (p.at.map != &map) continue;
        const std::string scheme = p.at.scheme->name;
        if (!cells.contains(scheme)) panels.push_back(scheme), cells[scheme] = lines[scheme] = Json::array();
        const std::size_t i = std::find(map.x.values.begin(), map.x.values.end(), p.at.x) - map.x.values.begin();
        const Verdict v = p.tried.judgement.verdict;
        seen.insert(v);
        Json cell{{"y", short_text(p.at.y)}, {"outcome", legend_text(v)}, {"letter", look_of(v).letter}, {"x", p.at.x}};
        if (numbers) cell["x"] = map.x.at[i], cell["from"] = edges(map.x, i).first, cell["to"] = edges(map.x, i).second;
        cells[scheme].push_back(cell);
    }
    for (const Boundary& b : run.boundaries) {
        if (b.map != &map || map.refine == 0) continue;
        const std::string y = short_text(b.y);
        lines[b.scheme->name].push_back({{"y", y}, {"x", 0.5 * (number_of(b.x_low) + number_of(b.x_high))}, {"line", "boundary"}});
        if (!std::isnan(b.theory)) lines[b.scheme->name].push_back({{"y", y}, {"x", b.theory}, {"line", "theory"}});
    }

    Json names = Json::array(), colours = Json::array();
    for (const Verdict v : seen) names.push_back(legend_text(v)), colours.push_back(look_of(v).colour);
    Json colour{{"field", "outcome"}, {"type", "nominal"}, {"scale", {{"domain", names}, {"range", colours}}}};
    const Json x_axis{{"title", title_of(map.x.key)}, {"format", ".2~g"}, {"labelOverlap", true}, {"labelFontSize", 10}};
    const Json y{{"field", "y"},
                 {"type", "ordinal"},
                 {"sort", rows},
                 {"scale", {{"domain", rows}, {"padding", 0}}},
                 {"axis", {{"title", y_title.empty() ? Json(nullptr) : Json(y_title)}}}};
    Json concat = Json::array();
    for (const std::string& scheme : panels) {
        colour["legend"] = scheme == panels.front() ? Json{{"title", nullptr}, {"orient", "top"}} : Json(nullptr);
        Json x{{"field", "x"}, {"type", numbers ? "quantitative" : "ordinal"}, {"axis", x_axis}};
        if (!numbers) x["axis"].erase("format"), x["sort"] = map.x.values;
        Json area = x;
        if (numbers) {
            const Json scale{{"type", log ? "log" : "linear"},
                             {"nice", false},
                             {"zero", false},
                             {"domain", {edges(map.x, 0).first, edges(map.x, map.x.at.size() - 1).second}}};
            x["scale"] = area["scale"] = scale;
            if (log) x["scale"].erase("zero"), area["scale"].erase("zero");
            area["field"] = "from";
        }
        Json rect{{"mark", {{"type", "rect"}, {"stroke", "white"}, {"strokeWidth", 0.5}}},
                  {"encoding", {{"x", area}, {"y", y}, {"color", colour}}}};
        if (numbers) rect["encoding"]["x2"] = {{"field", "to"}};
        Json layers = Json::array({rect,
                                   {{"mark", {{"type", "text"}, {"fontSize", 9}, {"color", "black"}}},
                                    {"encoding", {{"x", x}, {"y", y}, {"text", {{"field", "letter"}}}}}}});
        const auto marks = [&](const char* line, const Json& mark) {
            layers.push_back({{"data", {{"values", lines[scheme]}}},
                              {"transform", Json::array({{{"filter", std::string("datum.line == '") + line + "'"}}})},
                              {"mark", mark},
                              {"encoding", {{"x", x}, {"y", y}}}});
        };
        if (!lines[scheme].empty()) {
            marks("boundary",
                  {{"type", "tick"}, {"orient", "vertical"}, {"bandSize", 26}, {"thickness", 2}, {"color", "black"}, {"opacity", 1}});
            marks("theory", {{"type", "point"},
                             {"shape", "triangle-down"},
                             {"filled", true},
                             {"size", 70},
                             {"yOffset", -8},
                             {"color", "black"},
                             {"stroke", "white"},
                             {"opacity", 1}});
        }
        concat.push_back({{"title", {{"text", scheme}, {"fontSize", 11}}},
                          {"width", 210},
                          {"height", {{"step", 26}}},
                          {"data", {{"values", cells[scheme]}}},
                          {"layer", layers},
                          {"resolve", {{"scale", {{"color", "independent"}}}}}});
    }
    return Json{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"},
                {"title",
                 {{"text", map.name},
                  {"subtitle", map.scene + (map.refine > 0 ? "; line: boundary by bisection, triangle: theory" : "")},
                  {"anchor", "start"}}},
                {"background", "white"},
                {"columns", panels.size() < 3 ? panels.size() : 3},
                {"concat", concat},
                {"config", {{"aria", false}, {"view", {{"stroke", nullptr}}}, {"font", "DejaVu Sans, sans-serif"}}}}
        .dump();
}

}  // namespace jvari
