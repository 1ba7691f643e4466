#include "bench/command/console.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include "bench/store/system/interruption.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::command {

namespace {
using namespace std::chrono_literals;

void clear_line() { std::fputs("\r\033[K", stderr); }

// On a terminal that wants colours (https://no-color.org): what stands out by its mark stands out
// by its colour as well.
bool in_colour(int stream) {
    const char *no = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
    return isatty(stream) != 0 && !(no && *no) && !(terminal && std::strcmp(terminal, "dumb") == 0);
}

const char* colour_of(std::string_view line) {
    // on the front
    if (line.starts_with("* ")) return "\033[32m";
    // not to be trusted
    if (line.starts_with("! ") || line.starts_with("warning")) return "\033[33m";
    // an error
    if (line.starts_with("jvari: ")) return "\033[31m";
    // the answer
    if (line.starts_with("the cheapest") || (line.starts_with("  ") && line.find(" within ") == 18))
        return "\033[1m";
    return "";
}

// Names and notes come from files and plugins: what would steer the terminal is shown as a question
// mark.
std::string harmless(std::string text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]),
                   before = static_cast<unsigned char>(i > 0 ? text[i - 1] : 0);
        if ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7f) text[i] = '?';
        else if (before == 0xc2 && c >= 0x80 && c < 0xa0) text[i - 1] = text[i] = '?';
    }
    return text;
}

std::string coloured(const std::string& plain, int stream) {
    std::string text = harmless(plain);
    if (!in_colour(stream)) return text;
    std::string all;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t end = std::min(text.find('\n', from), text.size());
        const std::string line = text.substr(from, end - from), colour = colour_of(line);
        all += colour + line + (colour.empty() ? "" : "\033[0m") + (end < text.size() ? "\n" : "");
        from = end + 1;
    }
    return all;
}

std::FILE* own_output = stdout;

void put(const std::string& text) {
    const std::string line = coloured(text, STDOUT_FILENO) + "\n";
    if (std::fwrite(line.data(), 1, line.size(), own_output) != line.size() ||
        std::fflush(own_output) != 0)
        throw store::Unwritable(
            fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

std::optional<std::size_t> columns_of(int terminal) {
    winsize size{};
    if (ioctl(terminal, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return {};
    return size.ws_col;
}

// On a terminal a line that renews itself, elsewhere a line every ten seconds.
class Line : public store::Progress {
public:
    explicit Line(std::string job) : job_(std::move(job)) {}
    ~Line() override {
        if (shown_) clear_line();
    }
    void show(double fraction, const std::string& what) override {
        const auto now = std::chrono::steady_clock::now();
        if (now - start_ < 2s || now - last_ < pause_) return;
        last_ = now;
        const std::string line =
            harmless(fmt::format("{} {:3.0f} % {}", job_, 100 * fraction, what));
        if (!terminal_) return write_error(line);
        const store::Undisturbed whole;
        if (!shown_) shown_.emplace(clear_line);
        // a line that wraps could not be renewed
        std::fputs(
            ("\r\033[K" + line.substr(0, columns_of(STDERR_FILENO).value_or(80) - 1)).c_str(),
            stderr);
        std::fflush(stderr);
    }

private:
    std::string job_;
    const bool terminal_ = isatty(STDERR_FILENO) != 0;
    const std::chrono::milliseconds pause_ = terminal_ ? 200ms : 10000ms;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
    std::optional<store::WhenInterrupted> shown_;  // the line is cleared at an interruption, too
};
}  // namespace

void hold_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) != stream)
            _exit(exit_code::run_failed);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

void keep_standard_output() {
    const int own = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    std::FILE* file = own < 0 ? nullptr : fdopen(own, "w");
    if (!file) return;
    own_output = file;
    dup2(STDERR_FILENO, STDOUT_FILENO);
}

void write_error(const std::string& line) {
    std::fputs((coloured(line, STDERR_FILENO) + "\n").c_str(), stderr);
}

void Console::note(const std::string& text) const {
    if (!quiet_) write_error(text);
}

void Console::print(const std::string& text) const {
    if (!json_ && !quiet_) put(text);
}

void Console::print_json(const std::string& text) const {
    if (json_) put(text);
}

std::size_t Console::width() {
    const char* wanted = std::getenv("COLUMNS");
    if (const std::size_t columns = wanted ? std::strtoul(wanted, nullptr, 10) : 0; columns > 0)
        return columns;
    return columns_of(STDOUT_FILENO).value_or(std::numeric_limits<std::size_t>::max());
}

std::unique_ptr<store::Progress> Console::begin(const std::string& job) const {
    return quiet_ ? Listener::begin(job) : std::make_unique<Line>(job);
}

}  // namespace jvari::bench::command
