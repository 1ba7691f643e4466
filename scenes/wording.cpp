#include "scenes/wording.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <utility>

namespace jvari {

#if defined(__cpp_lib_to_chars)
std::string number_text(double x) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, x).ptr;
    return {text, end};
}

namespace {
template <class Real>
std::from_chars_result read(std::string_view text, Real& x) {
    return std::from_chars(text.data(), text.data() + text.size(), x);
}
}  // namespace

std::optional<double> number_of(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    double x = 0;
    auto [end, error] = read(text, x);
    if (error == std::errc::result_out_of_range) {
        long double wide = 0;
        error = read(text, wide).ec;
        if (error == std::errc()) x = static_cast<double>(wide);
        if (std::isinf(x)) return std::nullopt;
    }
    return error == std::errc() && end == text.data() + text.size() ? std::optional(x)
                                                                    : std::nullopt;
}
#else  // a standard library that has both only for whole numbers: Emscripten's
std::string number_text(double x) {
    char scientific[32], fixed[400];
    if (!std::isfinite(x)) return std::isnan(x) ? "nan" : x < 0 ? "-inf" : "inf";
    for (int digits = 0; digits < 17; ++digits) {
        std::snprintf(scientific, sizeof scientific, "%.*e", digits, x);
        if (std::strtod(scientific, nullptr) != x) continue;
        const int after_the_point = digits - std::atoi(std::strchr(scientific, 'e') + 1);
        std::snprintf(fixed, sizeof fixed, "%.*f", std::max(0, after_the_point), x);
        break;
    }
    return std::strlen(fixed) <= std::strlen(scientific) ? fixed : scientific;
}

std::optional<double> number_of(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    const std::string copy(text);
    if (copy.find_first_not_of("+-.0123456789eEinfatyINFATY") != std::string::npos ||
        copy.empty() || copy[0] == '+')
        return std::nullopt;
    char* end = nullptr;
    errno = 0;
    const double x = std::strtod(copy.c_str(), &end);
    return *end || (errno == ERANGE && std::isinf(x)) ? std::nullopt : std::optional(x);
}
#endif

std::string quote(std::string_view s) {
    std::string text = "\"";
    for (const char c : s) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            text += {'\\', c};
        } else if (code < 0x20 || code == 0x7f) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04X", code);
            text += escape;
        } else {
            text += c;
        }
    }
    return text + '"';
}

bool is_text(std::string_view s) {
    for (std::size_t i = 0; i < s.size();) {
        const auto at = [&](std::size_t k) { return static_cast<unsigned char>(s[k]); };
        const unsigned first = at(i);
        const std::size_t size = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
        unsigned code = size == 1 ? first : first & (0xffu >> (size + 1));
        if (first < 0x20 || first == 0x7f || (first >= 0x80 && first < 0xc2) || first > 0xf4 ||
            i + size > s.size())
            return false;
        for (std::size_t k = 1; k < size; ++k) {
            if ((at(i + k) & 0xc0) != 0x80) return false;
            code = code << 6 | (at(i + k) & 0x3fu);
        }
        const unsigned least[] = {0, 0x80, 0x800, 0x10000};
        if (code < least[size - 1] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000))
            return false;
        i += size;
    }
    return true;
}

std::string unfit_as_file(std::string_view name) {
    // leaves room below the 255 bytes that a file name may have
    constexpr std::size_t longest = 100;
    if (name.empty()) return "is empty";
    if (name.size() > longest)
        return "has " + std::to_string(name.size()) + " bytes, and at most " +
               std::to_string(longest) + " fit";
    if (name.front() == '.') return "begins with a point";
    const auto odd = std::find_if(name.begin(), name.end(), [](char c) {
        const auto code = static_cast<unsigned char>(c);
        return code < 0x20 || code == 0x7f || c == '/' || c == '\\';
    });
    return odd == name.end()             ? ""
           : *odd == '/' || *odd == '\\' ? "has a slash"
                                         : "has a control character";
}

std::string found_text(std::string_view s) {
    constexpr std::size_t longest = 60;
    if (s.size() <= longest) return quote(s);
    std::size_t end = longest;
    // not inside a UTF-8 sequence
    while (end > 0 && (static_cast<unsigned char>(s[end]) & 0xc0) == 0x80) --end;
    return quote(s.substr(0, end)) + "... (" + std::to_string(s.size()) + " bytes)";
}

std::string list_of(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& w : words) text += (text.empty() ? "" : ", ") + quote(w);
    return text;
}

namespace {
// Insertions, deletions, changes, and neighbours exchanged (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j - 1] + (a[i - 1] != b[j - 1]), last[j] + 1, row[j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = std::exchange(last, row);
    }
    return last.back();
}
}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
    std::string best;
    std::size_t least = word.size();
    for (const std::string& k : known) {
        const std::size_t distance = edit_distance(word, k);
        if (distance < least && 2 * distance <= std::max(word.size(), k.size()))
            least = distance, best = k;
    }
    return best;
}

}  // namespace jvari
