#include "bench/report/spectrogram_chart.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace jvari::bench::report {

void add_once(std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

namespace {
using Json = nlohmann::ordered_json;
constexpr int range = 800;  // [0.1 dB]

// Viridis (van der Walt & Smith 2015) starts here: the background, where nothing is drawn.
constexpr const char* darkest = "#440154";

struct Steps {
    int level = 20;            // [0.1 dB]
    int frames = 1, rows = 1;  // merged to one
};

enum class Layer { level, difference };
struct Tile {
    std::size_t panel;
    double from, to, low, high;  // [s], [kHz]
    int level;                   // [0.1 dB] below the common maximum, or above what it is seen against
};

// The strongest of the merged cells, in steps of level; -range for background.
int stepped(const study::Levels& l, int frame, int row, const Steps& s, int top) {
    int strongest = study::silent_level;
    for (int m = frame; m < std::min(frame + s.frames, l.frames); ++m)
        for (int r = row; r < std::min(row + s.rows, l.rows); ++r)
            strongest = std::max(strongest, l.level[static_cast<std::size_t>(m) * l.rows + r]);
    const int below = std::max(strongest - top, -range);
    return -((-below + s.level / 2) / s.level) * s.level;
}

std::vector<Tile> tiles_of(const std::vector<Panel>& panels, int top, const Steps& s, Layer layer) {
    std::vector<Tile> tiles;
    const int background = layer == Layer::level ? -range : 0;
    for (std::size_t p = 0; p < panels.size(); ++p) {
        const study::Levels& l = panels[p].levels;
        const study::Levels* against = panels[p].against ? &*panels[p].against : nullptr;
        if (layer == Layer::difference && !against) continue;
        const auto level_at = [&](int m, int row) {
            const int own = stepped(l, m, row, s, top);
            if (layer == Layer::level) return own;
            return m < against->frames && row < against->rows ? own - stepped(*against, m, row, s, top) : background;
        };
        for (int row = 0; row < l.rows; row += s.rows) {
            int before = background;
            for (int m = 0; m < l.frames; m += s.frames) {
                const int level = level_at(m, row);
                const double from = l.start + m * l.hop, to = l.start + std::min(m + s.frames, l.frames) * l.hop;
                const double low = row * l.row_hz / 1000, high = std::min(row + s.rows, l.rows) * l.row_hz / 1000;
                if (level == background) before = background;
                else if (level == before) tiles.back().to = to;
                else tiles.push_back({p, from, to, low, high, before = level});
            }
        }
    }
    return tiles;
}

struct Frame {
    double first, last, highest;  // [s], [s], [kHz]
    int width;                    // three pixels for each frame and two for each row, so that no seam shows
};

// Both kinds of tiles have one colour scale, which follows the choice.
Json panel_of(const Frame& f, const Json& values, bool leftmost, bool lowest, bool with_differences) {
    const auto axis = [](bool shown, const char* title) {
        return Json{{"title", shown ? Json(title) : Json()}, {"labels", shown}, {"tickCount", 4}, {"grid", false}};
    };
    const auto scale = [](double from, double to) { return Json{{"domain", {from, to}}, {"nice", false}, {"zero", false}}; };
    const auto quantity = [](const char* field, const Json& its_scale, const Json& its_axis) {
        return Json{{"field", field}, {"type", "quantitative"}, {"scale", its_scale}, {"axis", its_axis}};
    };
    const auto chosen = [with_differences](const Json& of_levels, const Json& of_differences) {
        const auto expression = [](const Json& j) { return j.dump(); };
        if (!with_differences) return of_levels;
        return Json{{"expr", fmt::format("shown_field == 'level' ? {} : {}", expression(of_levels), expression(of_differences))}};
    };
    Json panel{
        {"width", f.width},
        {"height", 200},
        {"view", {{"fill", chosen(darkest, "#f7f7f7")}}},
        {"data", {{"values", values}}},
        {"mark", {{"type", "rect"}, {"aria", false}, {"tooltip", nullptr}}},
        {"encoding",
         {{"x", quantity("a", scale(f.first, f.last), axis(lowest, "time [s]"))},
          {"x2", {{"field", "b"}}},
          {"y", quantity("f", scale(0, f.highest), axis(leftmost, "frequency [kHz]"))},
          {"y2", {{"field", "g"}}},
          {"color",
           {{"field", "l"},
            {"type", "quantitative"},
            {"scale",
             {{"scheme", chosen("viridis", "purpleorange")}, {"domain", Json::array({chosen(-80, -24), chosen(0, 24)})}, {"clamp", true}}},
            {"legend", {{"title", with_differences ? "dB" : "dB re common maximum"}, {"gradientLength", 200}}}}}}}};
    if (with_differences) panel["transform"] = Json::array({{{"filter", "datum.d == (shown_field == 'level' ? 0 : 1)"}}});
    return panel;
}

Json note_of(const Frame& f, const std::string& status) {
    return {{"width", f.width},
            {"height", 200},
            {"view", {{"fill", "#eee"}}},
            {"data", {{"values", Json::array({Json::object()})}}},
            {"mark", {{"type", "text"}, {"text", status}, {"fontSize", 12}}}};
}

double rounded(double x) {
    return std::round(x * 1e5) / 1e5;
}
}  // namespace

std::string spectrogram_spec(const std::string& title, const std::string& subtitle, std::vector<Panel> panels, int most) {
    int top = study::silent_level;
    double first = HUGE_VAL, last = 0, highest = 1;
    int frames = 1;
    std::vector<std::string> across, down;
    for (const Panel& p : panels) {
        const study::Levels& l = p.levels;
        add_once(across, p.across);
        add_once(down, p.down);
        for (int level : l.level) top = std::max(top, level);
        if (l.frames == 0) continue;
        first = std::min(first, l.start);
        last = std::max(last, l.start + l.frames * l.hop);
        highest = std::max(highest, l.rows * l.row_hz / 1000);
        frames = std::max(frames, l.frames);
    }
    Steps steps;
    std::vector<Tile> tiles = tiles_of(panels, top, steps, Layer::level), differences = tiles_of(panels, top, steps, Layer::difference);
    for (int round = 0; static_cast<int>(tiles.size() + differences.size()) > most && round < 12; ++round) {
        if (steps.level < 50) steps.level = steps.level == 20 ? 40 : 50;
        else if (round % 2 == 0) steps.frames *= 2;
        else steps.rows *= 2;
        tiles = tiles_of(panels, top, steps, Layer::level);
        differences = tiles_of(panels, top, steps, Layer::difference);
    }
    // Panel by panel, not by facet: those come in an order of their own when it is not that of the alphabet.
    std::vector<Json> values(panels.size(), Json::array());
    const auto value_of = [](const Tile& t) {
        return Json{{"a", rounded(t.from)}, {"b", rounded(t.to)}, {"f", rounded(t.low)}, {"g", rounded(t.high)}, {"l", t.level / 10.0}};
    };
    const bool with_differences = std::any_of(panels.begin(), panels.end(), [](const Panel& p) { return p.against.has_value(); });
    for (const Tile& t : tiles) {
        values[t.panel].push_back(value_of(t));
        if (with_differences) values[t.panel].back()["d"] = 0;
    }
    for (const Tile& t : differences) {
        values[t.panel].push_back(value_of(t));
        values[t.panel].back()["d"] = 1;
    }
    const Frame frame{std::isfinite(first) ? first : 0, last, highest, 3 * std::min(frames, 60)};
    Json grid = Json::array();
    for (const std::string& row : down)
        for (const std::string& column : across) {
            std::size_t p = 0;
            while (p < panels.size() && (panels[p].across != column || panels[p].down != row)) ++p;
            const bool sounds = p < panels.size() && panels[p].levels.frames > 0;
            Json panel = sounds ? panel_of(frame, values[p], column == across.front(), row == down.back(), with_differences)
                                : note_of(frame, p < panels.size() ? panels[p].status : "");
            if (row == down.front()) panel["title"] = {{"text", column}, {"fontSize", 10}};
            if (column == across.front() && sounds) panel["encoding"]["y"]["axis"]["title"] = {row, "frequency [kHz]"};
            grid.push_back(std::move(panel));
        }
    return Json{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"},
                {"params", with_differences ? Json::array({{{"name", "shown_field"}, {"value", "level"}}}) : Json::array()},
                {"title", {{"text", title}, {"subtitle", subtitle}, {"anchor", "start"}, {"offset", 14}}},
                {"background", "white"},
                {"padding", 12},
                {"columns", across.size()},
                {"spacing", 12},
                {"concat", grid},
                {"config", {{"font", "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif"}, {"view", {{"stroke", nullptr}}}}}}
        .dump();
}

}  // namespace jvari::bench::report
