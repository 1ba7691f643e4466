#include "bench/console.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

namespace jvari {

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
    : label_(std::move(label)), start_(std::chrono::steady_clock::now()), last_(start_), shown_(false),
      terminal_(!console.quiet_ && isatty(STDERR_FILENO) != 0) {}

Console::Progress::~Progress() {
    if (shown_) fmt::print(stderr, "\r\033[K");
}

void Console::Progress::show(double fraction, const std::string& what) {
    if (!terminal_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - start_ < std::chrono::seconds(2) || now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    shown_ = true;
    fmt::print(stderr, "\r\033[K{} {:3.0f} % {}", label_, 100 * fraction, what);
    std::fflush(stderr);
}

int edit_distance(const std::string& a, const std::string& b) {
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        int diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int changed = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

}  // namespace jvari
