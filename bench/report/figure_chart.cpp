// Where a line is a scheme it has the identity that it has everywhere; else names take the families' colours in the order in which the rows
// bring them up.
#include "bench/report/figure_chart.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/report/identity.hpp"
#include "bench/report/results.hpp"
#include "bench/report/spectrogram_chart.hpp"
#include "bench/report/vega.hpp"
#include "bench/suite/facet.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;
constexpr int most_rectangles = 2800;  // of a spectrogram: a file below 300 kB

bool same(const std::string& field, const std::string& wanted) {
    const double a = store::number_of(field), b = store::number_of(wanted);
    return std::isnan(a) || std::isnan(b) ? field == wanted : a == b;
}

void must_have(const store::Table& t, const suite::Figure& f, const std::string& column) {
    if (t.column(column) < 0) throw store::UsageError(fmt::format("table {}: {}", f.table, store::unknown("column", column, t.columns)));
}

bool chosen(const suite::Figure& f, const store::Table& t, std::size_t row) {
    return std::ranges::all_of(f.where, [&](const auto& w) {
        return std::ranges::any_of(w.second, [&](const std::string& value) { return same(t.at(row, w.first), value); });
    });
}

std::string name_in(const suite::Figure& f, const store::Table& t, std::size_t row, const std::vector<std::string>& columns) {
    std::string name;
    for (const std::string& column : columns)
        if (const std::string& field = t.at(row, column); !field.empty()) name += (name.empty() ? "" : ", ") + field;
    const auto label = std::ranges::find(f.labels, name, &std::pair<std::string, std::string>::first);
    return label == f.labels.end() ? name : label->second;
}

double drawn_number(double x) {  // five digits: a hundredth of a pixel
    return std::stod(fmt::format("{:.5g}", x));
}

Json wrapped(const std::string& text, std::size_t length) {
    Json lines = Json::array();
    std::string line;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        if (!line.empty() && line.size() + 1 + end - at > length) lines.push_back(std::exchange(line, ""));
        line += (line.empty() ? "" : " ") + text.substr(at, end - at);
        at = end + 1;
    }
    if (!line.empty()) lines.push_back(line);
    return lines;
}

// Without a screen Vega takes a letter for 0.8 of the font's size and makes the picture as wide as its longest line.
Json title_of(const suite::Figure& f, double width) {
    const std::string under = f.paper + (f.paper.empty() || f.statement.empty() ? "" : ": ") + f.statement;
    return {{"text", wrapped(f.title, static_cast<std::size_t>(width / (0.8 * 16)))},
            {"subtitle", wrapped(under, static_cast<std::size_t>(width / (0.8 * 12)))},
            {"anchor", "start"},
            {"offset", 14},
            {"subtitlePadding", 5}};
}

Json axis(const suite::FigureAxis& a, const char* field, bool free) {
    Json scale{{"zero", false}, {"nice", a.log || !free}};
    if (a.log) scale["type"] = "log";
    if (a.domain) scale["domain"] = *a.domain, scale["nice"] = false;
    Json encoded{{"field", field}, {"type", "quantitative"}, {"title", a.title}, {"scale", scale}};
    if (a.log) encoded["axis"]["format"] = "~g";
    return encoded;
}

// "; error_l2_50ms is empty in all rows, error_l2_10ms and error_l2_whole are not".
std::string why_none(const store::Table& t, const std::string& column) {
    const auto is_empty = [&t](const std::string& name) {
        for (std::size_t i = 0; i < t.rows.size(); ++i)
            if (!t.at(i, name).empty()) return false;
        return true;
    };
    if (t.rows.empty() || !is_empty(column)) return "";
    std::string others;
    const std::string family = column.substr(0, column.find('_'));
    for (const std::string& name : t.columns)
        if (name.starts_with(family) && !is_empty(name)) others += (others.empty() ? "; with numbers: " : ", ") + name;
    return fmt::format("; {} is empty in all rows{}", column, others);
}

const Json config = {{"font", "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif"},
                     {"axis", {{"gridOpacity", 0.45}, {"labelFontSize", 11}, {"titleFontSize", 12}}},
                     {"title", {{"fontSize", 16}, {"subtitleFontSize", 12}}},
                     {"header", {{"title", nullptr}, {"labelFontSize", 12}, {"labelFontWeight", "bold"}, {"labelAnchor", "start"}}},
                     {"legend", {{"labelFontSize", 12}, {"labelLimit", 500}, {"symbolStrokeWidth", 3}}}};

std::string spectrogram_figure(const suite::Figure& f, const std::vector<study::Record>& records, const store::Table& cells) {
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < records.size(); ++i)
        if (records[i].levels.frames > 0 && chosen(f, cells, i))
            panels.push_back({name_in(f, cells, i, f.colour), name_in(f, cells, i, f.panels), cells.at(i, "status"), records[i].levels});
    if (panels.empty()) throw store::UsageError("no cell with a spectrogram is left by `where`");
    const int scale = panels.size() == 1 ? 2 : 1;
    Json spec = Json::parse(spectrogram_spec(f.title, "", std::move(panels), most_rectangles));
    int width = 0;
    for (Json& panel : spec["concat"]) width += panel["width"].get<int>() * scale;
    spec["title"] = title_of(f, std::max(480, width));
    for (Json& panel : spec["concat"])
        for (const char* side : {"width", "height"}) panel[side] = panel[side].get<int>() * scale;
    return spec.dump();
}
}  // namespace

std::string figure_spec(const suite::Figure& f, const store::Table& t) {
    for (const std::string& column : {f.x.column, f.y.column}) must_have(t, f, column);
    if (!f.y.to.empty()) must_have(t, f, f.y.to);
    for (const auto* columns : {&f.colour, &f.panels})
        for (const std::string& column : *columns) must_have(t, f, column);
    for (const auto& [column, values] : f.where) must_have(t, f, column);

    Json values = Json::array();
    std::vector<std::string> colours, panels, first_texts;  // of the first column that names each colour
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        if (!chosen(f, t, i)) continue;
        const double x = t.number(i, f.x.column) * f.x.factor, y = t.number(i, f.y.column) * f.y.factor;
        const double to = f.y.to.empty() ? y : t.number(i, f.y.to) * f.y.factor;
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(to)) continue;
        if ((f.x.log && x <= 0) || (f.y.log && (y <= 0 || to <= 0))) continue;
        if (f.x.domain && (x < (*f.x.domain)[0] || x > (*f.x.domain)[1])) continue;
        Json row{{"x", drawn_number(x)}, {"y", drawn_number(y)}};
        if (!f.y.to.empty()) row["z"] = drawn_number(to);
        if (!f.colour.empty()) {
            add_once(colours, row["c"] = name_in(f, t, i, f.colour));
            if (first_texts.size() < colours.size()) first_texts.push_back(t.at(i, f.colour.front()));
        }
        if (!f.panels.empty()) add_once(panels, row["p"] = name_in(f, t, i, f.panels));
        values.push_back(std::move(row));
    }
    if (values.empty()) throw store::UsageError(fmt::format("table {}: no row is left to draw{}", f.table, why_none(t, f.y.column)));

    Json mark{{"type", f.kind == suite::FigureKind::band ? "area" : "line"}, {"clip", true}, {"tooltip", nullptr}, {"aria", false}};
    if (f.kind == suite::FigureKind::band) mark["opacity"] = colours.size() > 1 ? 0.6 : 0.9;
    else mark["strokeWidth"] = 1.4;
    if (f.kind == suite::FigureKind::points) mark["point"] = {{"size", 45}};
    if (f.kind == suite::FigureKind::points && f.colour.empty()) mark["point"]["color"] = families()[0].light;
    Json encoding{{"x", axis(f.x, "x", f.free)}, {"y", axis(f.y, "y", f.free)}};
    if (f.kind == suite::FigureKind::band) encoding["y2"] = {{"field", "z"}};
    else encoding["order"] = {{"field", "x"}};
    if (!f.colour.empty()) {
        Json range = Json::array();
        const bool schemes = f.colour.front() == "scheme" && f.colour.size() == 1;
        const auto identities = identities_of(schemes ? first_texts : colours);
        for (std::size_t k = 0; k < colours.size(); ++k)
            range.push_back(schemes ? identities[k].colour : families()[k % (families().size() - 1)].light);
        Json legend;
        if (colours.size() > 1) legend = {{"title", nullptr}, {"orient", "bottom"}, {"direction", "horizontal"}, {"columns", 3}};
        encoding["color"] = {{"field", "c"}, {"type", "nominal"}, {"scale", {{"domain", colours}, {"range", range}}}, {"legend", legend}};
        if (schemes && f.kind == suite::FigureKind::points) {
            Json shapes = Json::array();
            for (const Identity& i : identities) shapes.push_back(i.shape);
            encoding["shape"] = {
                {"field", "c"}, {"type", "nominal"}, {"scale", {{"domain", colours}, {"range", shapes}}}, {"legend", legend}};
        }
    } else {
        mark["color"] = families()[0].light;
    }
    Json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"},
              {"title", title_of(f, f.width * (f.panels.empty() ? 1 : std::min<int>(f.across, static_cast<int>(panels.size()))) + 60)},
              {"background", "white"},
              {"padding", 12},
              {"data", {{"values", values}}}};
    Json unit{{"width", f.width}, {"height", f.height}, {"mark", mark}, {"encoding", encoding}};
    if (f.panels.empty()) {
        spec.update(unit);
    } else {
        spec["facet"] = {{"field", "p"}, {"type", "nominal"}, {"sort", panels}};
        spec["columns"] = f.across;
        spec["spacing"] = 18;
        spec["spec"] = unit;
        if (f.free) spec["resolve"] = {{"scale", {{"x", "independent"}, {"y", "independent"}}}};
    }
    spec["config"] = config;
    return spec.dump();
}

namespace {
std::string in_one_picture(const std::string& left, const std::string& right) {
    Json both{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"}, {"background", "white"}, {"padding", 12}, {"spacing", 28}};
    for (const std::string& spec : {left, right}) {
        Json one = Json::parse(spec);
        for (const char* of_the_whole : {"$schema", "background", "padding", "config"}) one.erase(of_the_whole);
        both["hconcat"].push_back(std::move(one));
    }
    both["config"] = config;
    return both.dump();
}

template <class SpecOf>  // throws UsageError where a figure cannot be drawn
std::vector<DrawnFigure> drawn(const std::vector<suite::Figure>& figures, const store::Listener& listener, SpecOf spec_of) {
    std::vector<DrawnFigure> drawn;
    const Vega vega = find_vega();
    if (!vega.missing.empty()) {
        listener.note(vega.missing);
        return drawn;
    }
    for (const suite::Figure& f : figures) {
        const std::string file = "figure-" + f.name + ".svg";
        std::string why;
        try {
            std::string spec = spec_of(f);
            if (!f.beside.empty()) spec = in_one_picture(spec, spec_of(*std::ranges::find(figures, f.beside, &suite::Figure::name)));
            if (const auto svg = svg_of(vega, spec, why)) drawn.push_back({file, *svg});
        } catch (const store::UsageError& e) {
            why = e.what();
        }
        if (!why.empty()) listener.note(file + ": " + why);
    }
    return drawn;
}
}  // namespace

std::vector<DrawnFigure> draw_figures(const suite::Suite& suite, const study::Plan& plan, const std::vector<study::Record>& records,
                                      const store::Table& cells, const store::Listener& listener) {
    if (suite.figures.empty()) return {};
    return drawn(suite.figures, listener, [&](const suite::Figure& f) {
        if (f.kind == suite::FigureKind::spectrogram) return spectrogram_figure(f, records, cells);
        for (const suite::Facet& facet : suite::facets())
            if (facet.rows && f.table == facet.name) return figure_spec(f, study::rows_of(facet.name, plan, records));
        return figure_spec(f, cells);
    });
}

std::vector<DrawnFigure> redraw_figures(const std::filesystem::path& folder, const store::Listener& listener) {
    const std::string name = read_results(folder).suite;
    const auto known = suite::library_suites();
    if (std::find(known.begin(), known.end(), name) == known.end()) return {};
    std::vector<suite::Figure> figures = suite::read_suite(name).figures;
    std::erase_if(figures, [](const suite::Figure& f) { return f.kind == suite::FigureKind::spectrogram; });
    if (figures.empty()) return {};
    return drawn(figures, listener, [&](const suite::Figure& f) { return figure_spec(f, table_of(folder, f.table)); });
}

}  // namespace jvari::bench::report
