#include "bench/report/vega.hpp"

#include <strings.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "bench/report/page_text.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/system/program.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

namespace {
constexpr const char* libraries[] = {"vega/build/vega.min.js", "vega-lite/build/vega-lite.min.js", "vega-embed/build/vega-embed.min.js"};

std::optional<std::string> whole(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    if (!stream || !(text << stream.rdbuf())) return std::nullopt;
    return text.str();
}

fs::path temporary() {
    const char* set = std::getenv("TMPDIR");
    return set && *set ? set : "/tmp";
}

struct Scratch {  // a folder of our own, gone at the end
    Scratch() = default;
    ~Scratch() { remove(); }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    const fs::path path = [] {
        std::string name = (temporary() / "jvari-XXXXXX").string();
        return mkdtemp(name.data()) ? fs::path(name) : fs::path();
    }();

private:
    void remove() const {
        std::error_code ignored;
        if (!path.empty()) fs::remove_all(path, ignored);
    }
    const store::WhenInterrupted removed_{[this] { remove(); }};
};
}  // namespace

Vega find_vega() {
    const char* set = std::getenv("JVARI_NODE_MODULES");
    Vega v{set && *set ? set : JVARI_NODE_MODULES_FOLDER, ""};
    for (const char* library : libraries)
        if (!fs::exists(fs::path(v.folder) / library))
            v.missing =
                "no charts: " + (fs::path(v.folder) / library).string() + " is missing; `npm ci` at the root of the sources installs it";
    return v;
}

std::optional<std::string> vega_scripts(const Vega& v) {
    std::string all;
    for (const char* library : libraries) {
        auto text = whole(fs::path(v.folder) / library);
        if (!text) return std::nullopt;
        if (const auto map = text->rfind("//# sourceMappingURL"); map != std::string::npos) text->resize(map);
        all += "<script>" + inside_script(std::move(*text)) + "</script>\n";
    }
    return all;
}

std::string inside_script(std::string text) {
    const auto same = [&text](std::size_t at, const char* word) { return strncasecmp(text.c_str() + at, word, std::strlen(word)) == 0; };
    for (auto at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1))
        if (same(at, "</script") || same(at, "<!--")) text.insert(at + 1, 1, '\\');
    return text;
}

std::vector<std::optional<std::string>> svgs_of(const Vega& v, const std::vector<std::string>& specs, std::string& why) {
    std::vector<std::optional<std::string>> svgs(specs.size());
    if (specs.empty()) return svgs;
    const Scratch scratch;
    const auto file = [&scratch](const std::string& name) { return scratch.path / name; };
    bool written = !scratch.path.empty() && (std::ofstream(file("draw.js"), std::ios::binary) << page_text("draw.js"));
    for (std::size_t k = 0; written && k < specs.size(); ++k)
        written = static_cast<bool>(std::ofstream(file("spec." + std::to_string(k) + ".json"), std::ios::binary) << specs[k]);
    if (!written) {
        why = "no picture: cannot write to " + temporary().string();
        return svgs;
    }
    std::error_code error;
    const fs::path modules = fs::absolute(v.folder, error);
    const store::Said drawn = store::run_program(
        {"env", "--chdir=" + scratch.path.string(), "NODE_PATH=" + modules.string(), "node", "draw.js", std::to_string(specs.size())},
        store::Errors::with_the_rest);
    for (std::size_t k = 0; k < specs.size(); ++k) {
        const auto svg = whole(file(std::to_string(k) + ".svg"));
        if (svg && svg->rfind("<svg", 0) == 0) svgs[k] = svg;
        else if (why.empty() && drawn.code == 127) why = "no picture: node is missing (Debian: apt-get install nodejs npm)";
        else if (why.empty())
            why = "no picture: vega failed: " + whole(file(std::to_string(k) + ".said")).value_or(drawn.text).substr(0, 400);
    }
    return svgs;
}

std::optional<std::string> svg_of(const Vega& v, const std::string& spec, std::string& why) {
    return svgs_of(v, {spec}, why).front();
}

}  // namespace jvari::bench::report
