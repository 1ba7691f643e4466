#include "bench/report/vega.hpp"

#include <strings.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/folders.hpp"
#include "bench/report/report.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/program.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;
constexpr const char* libraries[] = {"vega/build/vega.min.js", "vega-lite/build/vega-lite.min.js",
                                     "vega-embed/build/vega-embed.min.js"};

std::optional<std::string> whole(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    if (!stream || !(text << stream.rdbuf())) return std::nullopt;
    return text.str();
}
}  // namespace

Vega find_vega() {
    const char* set = std::getenv("JVARI_NODE_MODULES");
    Vega v{set && *set ? set : JVARI_NODE_MODULES_FOLDER, ""};
    for (const char* library : libraries)
        if (!fs::exists(fs::path(v.folder) / library))
            v.missing = "no charts: " + (fs::path(v.folder) / library).string() +
                        " is missing; `npm ci` at the root of the sources installs it";
    return v;
}

std::optional<std::string> vega_scripts(const Vega& v) {
    std::string all;
    for (const char* library : libraries) {
        auto text = whole(fs::path(v.folder) / library);
        if (!text) return std::nullopt;
        if (const auto map = text->rfind("//# sourceMappingURL"); map != std::string::npos)
            text->resize(map);
        const fs::path package = fs::path(v.folder) / fs::path(library).begin()->c_str();
        auto licence = whole(package / "LICENSE");
        // vega comes without a licence file; the text in vega-lite is the same.
        if (!licence) licence = whole(package.parent_path() / "vega-lite/LICENSE");
        // The licence requires the notice in every copy.
        if (licence) *text = "/*\n" + *licence + "*/\n" + *text;
        all += "<script>" + inside_script(std::move(*text)) + "</script>\n";
    }
    return all;
}

std::string inside_script(std::string text) {
    const auto same = [&text](std::size_t at, const char* word) {
        return strncasecmp(text.c_str() + at, word, std::strlen(word)) == 0;
    };
    for (auto at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1))
        if (same(at, "</script") || same(at, "<!--")) text.insert(at + 1, 1, '\\');
    return text;
}

Drawn draw(const Vega& v, const Json& data) {
    Drawn drawn;
    const store::Scratch scratch;
    const auto file = [&scratch](const char* name) { return scratch.path / name; };
    const auto write = [](const fs::path& path, const std::string& text) {
        return static_cast<bool>(std::ofstream(path, std::ios::binary) << text);
    };
    const std::string program =
        "const page = JSON.parse(require(\"fs\").readFileSync(\"page.json\", \"utf8\"));\n" +
        shared_program() + page_text("draw.js") + "draw_all();\n";
    if (scratch.path.empty() || !write(file("draw.js"), program) ||
        !write(file("page.json"), store::compact(data))) {
        drawn.notes.push_back("no picture: cannot write to " + store::Scratch::place().string());
        return drawn;
    }
    std::error_code error;
    const fs::path modules = fs::absolute(v.folder, error);
    const store::Said output =
        store::run_program({"env", "--chdir=" + scratch.path.string(),
                            "NODE_PATH=" + modules.string(), "node", "draw.js"});
    const auto list = whole(file("drawn.json"));
    if (!list) {
        drawn.notes.push_back(
            output.code == 127 ? "no picture: node is missing (Debian: apt-get install nodejs npm)"
                               : "no picture: vega failed: " + output.text.substr(0, 400));
        return drawn;
    }
    const Json answer = store::parsed(*list);
    for (const std::string name : answer.at("drawn"))
        drawn.svgs.emplace_back(name, whole(file(name.c_str())).value_or(""));
    for (const Json& one : answer.at("failed"))
        drawn.notes.push_back(one.at(0).get<std::string>() + ": " + one.at(1).get<std::string>());
    return drawn;
}

double width_of(const std::string& text) {
    const auto unit = text.find_first_not_of("0123456789.");
    const double x = store::number_of(text.substr(0, unit)),
                 mm = unit == text.npos           ? x
                      : text.substr(unit) == "mm" ? x
                      : text.substr(unit) == "cm" ? 10 * x
                      : text.substr(unit) == "in" ? 25.4 * x
                                                  : nan;
    if (!(mm >= 40 && mm <= 1000))
        throw store::UsageError("--width " + text +
                                ": expected a width from 40mm to 1000mm, as 85mm, 8.5cm or 3.3in");
    return mm;
}

}  // namespace jvari::bench::report
