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

}  // namespace jvari::bench::command
