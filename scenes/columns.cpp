#include "scenes/columns.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "scenes/scene_file.hpp"
#include "scenes/schema.hpp"
#include "scenes/wording.hpp"

namespace jvari {

std::string text_of_file(const std::string& path, std::size_t limit) {
    std::error_code error;
    if (path.find('\0') != std::string::npos || std::filesystem::is_directory(path, error))
        throw std::runtime_error("is no file");
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot be read");
    std::string text;
    char block[1 << 14];
    while (in.read(block, sizeof block), in.gcount() > 0) {
        text.append(block, static_cast<std::size_t>(in.gcount()));
        if (text.size() > limit)
            throw std::runtime_error("is larger than " + std::to_string(limit) + " bytes");
    }
    return text;
}

namespace {
std::string_view trimmed(std::string_view s) {
    const auto begin = s.find_first_not_of(" \t\r"), end = s.find_last_not_of(" \t\r");
    return begin == std::string_view::npos ? std::string_view() : s.substr(begin, end - begin + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        cells.push_back(trimmed(line.substr(begin, end - begin)));
        begin = end + 1;
    }
    return cells;
}

struct ColumnLine {
    std::string place;  // "modes.csv:12"

    std::size_t find(const std::vector<std::string_view>& header, const Column& c) const {
        for (const char* name : {c.name, c.alias}) {
            const auto at = std::find(header.begin(), header.end(), name);
            if (at == header.end()) continue;
            if (std::find(at + 1, header.end(), name) != header.end())
                throw SceneFileError(place + ": header: found two columns " + quote(name) +
                                     ", expected one");
            return static_cast<std::size_t>(at - header.begin());
        }
        const bool semicolons =
            header.size() == 1 && header[0].find_first_of(";\t") != std::string_view::npos;
        throw SceneFileError(
            place + ": header: found no column " + quote(c.name) +
            (semicolons ? "; expected commas between columns, and points in numbers, as 0.5" : ""));
    }

    double number(const std::vector<std::string_view>& cells, std::size_t i,
                  const Column& c) const {
        const std::string_view cell = i < cells.size() ? cells[i] : "";
        const auto x = number_of(cell);
        if (!x || !c.range.holds(*x))
            throw SceneFileError(place + ": " + c.name + ": found " + found_text(cell) +
                                 ", expected " + c.range.says);
        return *x;
    }
};
}  // namespace

void read_columns(const std::string& path, const std::string& text, const Column& first,
                  std::vector<double>& a, const Column& second, std::vector<double>& b) {
    std::size_t column_a = 0, column_b = 0;
    bool header = true;
    int line = 0;
    for (std::size_t begin = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
         begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view one = trimmed(std::string_view(text).substr(begin, end - begin));
        const ColumnLine at{path + ":" + std::to_string(++line)};
        begin = end + 1;
        if (one.empty() || one.front() == '#') continue;
        const auto cells = cells_of(one);
        if (header) {
            column_a = at.find(cells, first), column_b = at.find(cells, second);
            header = false;
            continue;
        }
        a.push_back(at.number(cells, column_a, first));
        b.push_back(at.number(cells, column_b, second));
    }
    if (header)
        throw SceneFileError(path + ":1: found no header, expected the columns " +
                             list_of({first.name, second.name}));
}

}  // namespace jvari
