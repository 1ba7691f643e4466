#include "bench/report/vega.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <strings.h>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "bench/report/page_text.hpp"
#include "bench/store/interruption.hpp"

extern char** environ;

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

// Runs a program found on the PATH, its output into a file; returns its exit code, or -errno where it cannot be started.
int spawn(std::vector<std::string> words, const fs::path& output) {
    std::vector<char*> argv;
    for (std::string& w : words) argv.push_back(w.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    posix_spawnattr_t attributes;  // Ctrl-C is for it as well: blocked in this program (interruption.hpp), not in that one
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    sigset_t held;  // and what this program holds as errors of writing (console.hpp) are signals to it
    sigemptyset(&held);
    sigaddset(&held, SIGPIPE);
    sigaddset(&held, SIGXFSZ);
    posix_spawnattr_setsigdefault(&attributes, &held);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) return -failed;
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return -errno;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
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
    const int code =
        spawn({"env", "--chdir=" + scratch.path.string(), "NODE_PATH=" + modules.string(), "node", "draw.js", std::to_string(specs.size())},
              file("said"));
    for (std::size_t k = 0; k < specs.size(); ++k) {
        const auto svg = whole(file(std::to_string(k) + ".svg"));
        if (svg && svg->rfind("<svg", 0) == 0) svgs[k] = svg;
        else if (why.empty() && code == 127) why = "no picture: node is missing (Debian: apt-get install nodejs npm)";
        else if (why.empty())
            why = "no picture: vega failed: " +
                  whole(file(std::to_string(k) + ".said")).value_or(whole(file("said")).value_or("")).substr(0, 400);
    }
    return svgs;
}

std::optional<std::string> svg_of(const Vega& v, const std::string& spec, std::string& why) {
    return svgs_of(v, {spec}, why).front();
}

}  // namespace jvari::bench::report
