#include "bench/command/text_table.hpp"

#include <algorithm>
#include <numeric>

namespace jvari::bench::command {

namespace {
std::size_t shown(const std::string& text) {  // characters of UTF-8
    return static_cast<std::size_t>(std::ranges::count_if(text, [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}
}  // namespace

std::string TextTable::text(std::size_t width) const {
    std::vector<std::size_t> widths, kept(columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
        widths.push_back(shown(columns[k].head));
        for (const Row& row : rows) widths[k] = std::max(widths[k], shown(row.fields.at(k)));
    }
    std::iota(kept.begin(), kept.end(), 0);
    const auto total = [&] {
        return std::accumulate(kept.begin(), kept.end(), std::size_t{0}, [&](auto sum, auto k) { return sum + 2 + widths[k]; });
    };
    std::string left_out;
    while (total() > width) {
        const auto last = std::ranges::max_element(kept, {}, [this](std::size_t k) { return columns[k].rank; });
        if (columns[*last].rank == 0) break;
        left_out = columns[*last].head + (left_out.empty() ? "" : ", ") + left_out;
        kept.erase(last);
    }
    const bool folded = total() > width;
    std::string text, above;
    const auto line = [&](char mark, const auto& field) {
        if (folded && field(0) != above) text += "  " + (above = field(0)) + "\n";
        std::string fields = folded ? "   " : "";
        for (const std::size_t k : kept) {
            if (folded && k == 0) continue;
            const std::string padding(widths[k] - shown(field(k)), ' ');
            fields += (columns[k].left ? field(k) + padding : padding + field(k)) + "  ";
        }
        text += std::string(1, mark) + " " + fields.substr(0, fields.find_last_not_of(' ') + 1) + "\n";
    };
    line(' ', [&](std::size_t k) { return columns[k].head; });
    for (const Row& row : rows) line(row.mark, [&](std::size_t k) { return row.fields[k]; });
    if (!left_out.empty())
        text += "Not shown, because the terminal is narrow: " + left_out + ". --json and the tables of --out have them.\n";
    return text;
}

namespace {
constexpr std::size_t least_column = 24;

std::size_t last_column(const std::string& line, std::size_t width) {
    std::size_t column = std::min(line.find_first_not_of(' '), line.size());
    for (std::size_t gap = line.find("  ", column); gap != std::string::npos;) {
        const std::size_t next = line.find_first_not_of(' ', gap);
        if (next == std::string::npos || shown(line.substr(0, next)) + least_column > width) break;
        column = shown(line.substr(0, next));
        gap = line.find("  ", next);
    }
    return column;
}

std::string wrapped_line(std::string line, std::size_t width) {
    const std::string indent(last_column(line, width), ' ');
    std::string text;
    while (shown(line) > width) {
        std::size_t end = std::string::npos;  // of the words that fit, of the first one where none does
        for (std::size_t at = line.find(' ', line.find_first_not_of(' ')); at != std::string::npos; at = line.find(' ', at + 1)) {
            if (end != std::string::npos && shown(line.substr(0, at)) > width) break;
            end = at;
        }
        const std::size_t rest = line.find_first_not_of(' ', end);
        if (rest == std::string::npos) break;
        text += line.substr(0, line.find_last_not_of(' ', end) + 1) + "\n";
        line = indent + line.substr(rest);
    }
    return text + line;
}
}  // namespace

std::string wrapped(const std::string& text, std::size_t width) {
    std::string all;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t end = std::min(text.find('\n', from), text.size());
        all += wrapped_line(text.substr(from, end - from), width) + (end < text.size() ? "\n" : "");
        from = end + 1;
    }
    return all;
}

}  // namespace jvari::bench::command
