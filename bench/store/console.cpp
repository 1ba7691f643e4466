#include "bench/store/console.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>

#include "scenes/wording.hpp"

namespace jvari {

namespace {
void clear_line() {
    fmt::print(stderr, "\r\033[K");
}
}  // namespace

void Console::note(const std::string& text) const {
    if (!quiet_) fmt::print(stderr, "{}\n", text);
}

void Console::print(const std::string& text) const {
    if (json_) return;
    fmt::print(stdout, "{}\n", text);
    std::fflush(stdout);
}

void Console::print_json(const std::string& text) const {
    if (!json_) return;
    fmt::print(stdout, "{}\n", text);
    std::fflush(stdout);
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
    fmt::print(stderr, "\r\033[K{} {:3.0f} % {}", label_, 100 * fraction, what);
    std::fflush(stderr);
}

std::string unknown(const std::string& kind, const std::string& word, const std::vector<std::string>& known) {
    const std::string near = nearest(word, known);
    return "unknown " + kind + " " + found_text(word) + "; " +
           (!near.empty()   ? "did you mean " + quote(near) + "?"
            : known.empty() ? "there is none"
                            : "there is " + list_of(known));
}

}  // namespace jvari
