#include "bench/report/report.hpp"

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "bench/folders.hpp"
#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"
#include "scenes/installed.hpp"

namespace jvari::bench::report {

namespace {
// JSON for a <script> element: '<' occurs only within its strings, where an escape may replace it.
std::string island(const nlohmann::ordered_json& j) {
    std::string safe;
    for (const char c : store::compact(j)) {
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
    return joined({"data.js", "looks.js", "work_precision.js", "along.js", "maps.js",
                   "sound_charts.js", "run.js", "share.js", "verdict.js"});
}
static std::string page_program() {
    return shared_program() +
           joined({"table.js", "view.js", "chart.js", "player.js", "answer.js", "page.js"});
}

std::string page_of(const nlohmann::ordered_json& data, const std::string& scripts) {
    const std::pair<const char*, std::string> parts[] = {
        {"@TITLE@", store::escaped(data.at("title"))},
        {"@STYLE@", joined({"base.css", "page.css"})},
        {"@SCRIPTS@", scripts},
        {"@DATA@", island(data)},
        {"@PROGRAM@", page_program()}};
    std::string text;
    std::string rest = page_text("page.html");
    // Marks are replaced in page order, so inserted text is not searched.
    for (const auto& [mark, part] : parts) {
        const auto at = rest.find(mark);
        text += rest.substr(0, at) + part;
        rest.erase(0, at + std::string(mark).size());
    }
    return text + rest;
}

const char* page_text(const char* name) {
    for (const PageText& t : page_texts())
        if (std::strcmp(t.name, name) == 0) return t.text;
    throw std::logic_error(std::string("no text of the page is called ") + name);
}

namespace fs = std::filesystem;

std::string playground() {
    std::error_code error;
    for (const fs::path& page : {installed("play.html"), fs::path(JVARI_SOURCE_PLAYGROUND)})
        if (fs::is_regular_file(page, error)) return store::read_whole(page);
    throw store::UsageError("the playground has not been built: " JVARI_SOURCE_PLAYGROUND
                            " is missing. ./play builds it");
}

std::string with_playground(const std::string& report, const std::string& play) {
    const std::string added = std::string(
                                  "<details class=\"part\" id=\"playground\"><summary><h2>The "
                                  "string in the page</h2></summary></details>\n") +
                              "<script type=\"text/plain\" id=\"play\">" + store::base64(play) +
                              "</script>\n<script>\n" + page_text("playground.js") + "</script>\n";
    std::string whole = report;
    return whole.insert(whole.rfind("</body>"), added);
}

}  // namespace jvari::bench::report
