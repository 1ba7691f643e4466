#include "bench/report/page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/report/identity.hpp"
#include "bench/report/page_text.hpp"
#include "bench/store/base64.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
    return safe;
}

// JSON that stands inside <script>: '<' occurs in its strings alone, and may be written as an escape there.
std::string island(const Json& j) {
    std::string safe;
    for (const char c : j.dump(-1, ' ', false, Json::error_handler_t::replace)) {
        if (c == '<') safe += "\\u003c";
        else safe += c;
    }
    return safe;
}

std::size_t size_of(const store::Table& t) {
    std::size_t size = 0;
    for (const auto& row : t.rows)
        for (const std::string& field : row) size += field.size() + 3;
    return size;
}

// The table as it fits: every column, else the first ones, else fewer rows.
Json table_json(Section s) {
    std::size_t rows = s.table.rows.size();
    if (size_of(s.table) > table_limit && !s.first_columns.empty()) {
        std::vector<std::string> names = s.first_columns;
        if (s.table.column("pareto") >= 0) names.emplace_back("pareto");
        s.table = s.table.only(names);
        s.left_out.push_back("The table holds the most asked-for columns; all are in the csv file beside the page.");
    }
    if (const std::size_t size = size_of(s.table); size > table_limit) {
        rows = rows * table_limit / size;
        s.left_out.push_back(
            fmt::format("The table holds the first {} of {} rows; all are in the csv file beside the page.", rows, s.table.rows.size()));
        s.table.rows.resize(rows);
    }
    Json shown = Json::object();
    for (const Shown& f : s.shown)
        if (f.row < s.table.rows.size() && s.table.column(f.column) >= 0) shown[f.column][std::to_string(f.row)] = f.text;
    return {{"columns", s.table.columns}, {"rows", s.table.rows}, {"first", s.first_columns}, {"shown", shown}, {"left_out", s.left_out}};
}

Json json_of(const Section& s, bool drawn) {
    Json charts = Json::array(), pictures = Json::array(), sounds = Json::array();
    for (const Chart& c : s.charts) {
        if (!drawn) break;
        Json menus = Json::array();
        for (const Menu& m : c.menus) {
            Json choices = Json::array();
            for (const auto& [value, text] : m.choices) choices.push_back({Json::parse(value), text});
            menus.push_back({{"label", m.label}, {"signal", m.signal}, {"choices", choices}, {"scenes", m.scenes}});
        }
        Json offers = Json::object();
        for (const auto& [scene, errors] : c.offers) offers[scene] = errors;
        charts.push_back({{"name", c.name}, {"spec", Json::parse(c.spec)}, {"scrolls", c.scrolls}, {"menus", menus}, {"offers", offers}});
    }
    for (const Picture& p : s.pictures)
        pictures.push_back({{"name", p.name}, {"data", "data:image/svg+xml;base64," + store::base64(p.svg)}});
    for (const Heard& h : s.sounds)
        sounds.push_back({{"scheme", h.scheme}, {"detail", h.detail}, {"problem", h.problem}, {"wav", store::base64(h.wav)}});
    const Json table = table_json(s);
    return {{"id", s.id},
            {"heading", s.heading},
            {"notes", s.notes},
            {"charts", charts},
            {"pictures", pictures},
            {"sounds", sounds},
            {"left_out", table.at("left_out")},
            {"table", s.table.rows.empty() ? Json() : table}};
}
}  // namespace

std::string page_of(const Page& page) {
    Json sections = Json::array();
    const bool drawn = !page.scripts.empty();
    for (const Section& s : page.sections)
        if ((drawn && !s.charts.empty()) || !s.pictures.empty() || !s.sounds.empty() || !s.left_out.empty() || !s.table.rows.empty())
            sections.push_back(json_of(s, drawn));
    Json verdicts = Json::array(), dark = Json::object();
    for (const Verdict& v : page.verdicts) {
        Json answers = Json::array();
        for (const Answer& a : v.answers)
            answers.push_back({{"within", a.within},
                               {"scheme", a.scheme},
                               {"modes", a.modes},
                               {"rate", a.rate},
                               {"error", a.error},
                               {"cost", a.cost},
                               {"certain", a.certain},
                               {"colour", a.colour}});
        verdicts.push_back({{"scene", v.scene}, {"finding", v.finding}, {"answers", answers}, {"sentences", v.sentences}});
    }
    for (const Family& f : families()) dark[f.light] = f.dark;
    for (const Neutral& n : {ink, front_edge, front_track}) dark[n.light] = n.dark;
    const Json data{{"title", page.title},     {"finding", page.finding}, {"about", page.about},
                    {"command", page.command}, {"verdicts", verdicts},    {"dark", dark},
                    {"missing", page.missing}, {"sections", sections},    {"manifest", Json::parse(page.manifest, nullptr, false)}};
    std::string program;
    for (const char* file : {"table.js", "view.js", "chart.js", "player.js", "page.js"}) program += page_text(file);
    const std::pair<const char*, std::string> parts[] = {{"@TITLE@", escaped(page.title)},
                                                         {"@STYLE@", page_text("page.css")},
                                                         {"@SCRIPTS@", page.scripts},
                                                         {"@DATA@", island(data)},
                                                         {"@PROGRAM@", program}};
    std::string text;
    std::string rest = page_text("page.html");
    for (const auto& [mark, part] : parts) {  // in the order in which they stand, so that what is put in is not looked through
        const auto at = rest.find(mark);
        text += rest.substr(0, at) + part;
        rest.erase(0, at + std::string(mark).size());
    }
    return text + rest;
}

std::string fitting_page_of(Page page, std::size_t limit) {
    std::string html = page_of(page);
    std::size_t excess = html.size() > limit ? html.size() - limit + 2000 : 0;
    if (excess == 0) return html;
    const auto leave_out = [&excess](auto& parts, auto bytes, const char* what, Section& s) {
        std::size_t count = 0;
        for (; excess > 0 && !parts.empty(); ++count) {
            excess -= std::min(excess, bytes(parts.back()) * 4 / 3);
            parts.pop_back();
        }
        if (count > 0) s.left_out.push_back(fmt::format("{} {} are left out for the page's size; they lie beside it.", count, what));
    };
    for (Section& s : page.sections)
        leave_out(
            s.pictures, [](const Picture& p) { return p.svg.size(); }, "pictures", s);
    for (Section& s : page.sections)
        leave_out(
            s.sounds, [](const Heard& h) { return h.wav.size(); }, "more sounds", s);
    return page_of(page);
}

}  // namespace jvari::bench::report
