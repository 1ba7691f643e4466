#include "bench/store/console.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "scenes/wording.hpp"

namespace jvari::bench::store {

namespace {
void clear_line() {
    std::fputs("\r\033[K", stderr);
}

void put(const std::string& text) {
    const std::string line = text + "\n";
    if (std::fwrite(line.data(), 1, line.size(), stdout) != line.size() || std::fflush(stdout) != 0)
        throw Unwritable(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}
}  // namespace

void hold_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) != stream) _exit(run_failed);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

void tell(const std::string& line) {
    std::fputs((line + "\n").c_str(), stderr);
}

void Console::note(const std::string& text) const {
    if (!quiet_) tell(text);
}

void Console::print(const std::string& text) const {
    if (!json_) put(text);
}

void Console::print_json(const std::string& text) const {
    if (json_) put(text);
}

Console::Progress::Progress(const Console& console, std::string label)
    : label_(std::move(label)),
      start_(std::chrono::steady_clock::now()),
      last_(start_),
      terminal_(!console.quiet_ && isatty(STDERR_FILENO) != 0) {}

Console::Progress::~Progress() {
    if (shown_) clear_line();
}

void Console::Progress::show(double fraction, const std::string& what) {
    if (!terminal_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - start_ < std::chrono::seconds(2) || now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    const Undisturbed line;
    if (!shown_) shown_.emplace(clear_line);
    std::fputs(fmt::format("\r\033[K{} {:3.0f} % {}", label_, 100 * fraction, what).c_str(), stderr);
    std::fflush(stderr);
}

std::string unknown(const std::string& kind, const std::string& word, const std::vector<std::string>& known) {
    const std::string near = nearest(word, known);
    return "unknown " + kind + " " + found_text(word) + "; " +
           (!near.empty()   ? "did you mean " + quote(near) + "?"
            : known.empty() ? "there is none"
                            : "there is " + list_of(known));
}

}  // namespace jvari::bench::store
