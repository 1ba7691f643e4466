#include "bench/report/page.hpp"

#include <nlohmann/json.hpp>

#include "bench/report/page_text.hpp"

namespace jvari::bench::report {

namespace {
std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
    return safe;
}

// JSON that stands inside <script>: '<' occurs in its strings alone, and may be written as an escape there.
std::string island(const nlohmann::ordered_json& j) {
    std::string safe;
    for (const char c : j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) {
        if (c == '<') safe += "\\u003c";
        else safe += c;
    }
    return safe;
}

std::string joined(std::initializer_list<const char*> files) {
    std::string all;
    for (const char* file : files) all += page_text(file);
    return all;
}
}  // namespace

std::string shared_program() {
    return joined({"data.js", "looks.js", "work_precision.js", "along.js", "maps.js", "sound_charts.js", "run.js", "verdict.js"});
}
static std::string page_program() {
    return shared_program() + joined({"table.js", "view.js", "chart.js", "motion.js", "player.js", "page.js"});
}

std::string page_of(const nlohmann::ordered_json& data, const std::string& scripts) {
    const std::pair<const char*, std::string> parts[] = {{"@TITLE@", escaped(data.at("title"))},
                                                         {"@STYLE@", page_text("page.css")},
                                                         {"@SCRIPTS@", scripts},
                                                         {"@DATA@", island(data)},
                                                         {"@PROGRAM@", page_program()}};
    std::string text;
    std::string rest = page_text("page.html");
    for (const auto& [mark, part] : parts) {  // in the order in which they stand, so that what is put in is not looked through
        const auto at = rest.find(mark);
        text += rest.substr(0, at) + part;
        rest.erase(0, at + std::string(mark).size());
    }
    return text + rest;
}

}  // namespace jvari::bench::report
