#include "scenes/columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "scenes/scene_file.hpp"
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

// Column of a table: its place in a row, and the spelling in the header.
struct Found {
    std::size_t at = 0;
    const char* name = nullptr;
    double (*in_si)(double, double) = nullptr;  // nullptr: in SI units as it is
};

char lower(char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 'a' - 'A' : c); }

// Words that differ at most in capital letters are alike.
bool alike(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

struct ColumnLine {
    std::string place;  // "modes.csv:12"

    std::optional<Found> find(const std::vector<std::string_view>& header, const Column& c) const {
        std::vector<Spelling> known{{c.name, nullptr}, {c.alias, nullptr}};
        known.insert(known.end(), c.others.begin(), c.others.end());
        for (const Spelling& s : known) {
            const auto same = [&s](std::string_view cell) { return alike(cell, s.name); };
            const auto at = std::find_if(header.begin(), header.end(), same);
            if (at == header.end()) continue;
            if (std::find_if(at + 1, header.end(), same) != header.end())
                throw SceneFileError(place + ": header: found two columns " + quote(s.name) +
                                     ", expected one");
            return Found{static_cast<std::size_t>(at - header.begin()), s.name, s.in_si};
        }
        return {};
    }
    // All columns of a header, or a refusal that names every absent one and its other spellings.
    std::vector<std::optional<Found>> find(const std::vector<std::string_view>& header,
                                           std::span<const ColumnTo> columns) const {
        std::vector<std::optional<Found>> all;
        std::string absent;
        int lacking = 0;
        for (const ColumnTo& c : columns) {
            all.push_back(find(header, c.column));
            if (all.back() || c.may_lack) continue;
            std::vector<std::string> others;
            if (std::string_view(c.column.alias) != c.column.name) others = {c.column.alias};
            for (const Spelling& s : c.column.others) others.emplace_back(s.name);
            absent += (lacking++ ? ", " : "") + quote(c.column.name) +
                      (others.empty() ? "" : " (or " + list_of(others) + ")");
        }
        if (!lacking) return all;
        if (header.size() == 1 && header[0].find_first_of(";\t") != std::string_view::npos)
            throw SceneFileError(
                place + ": header: found " + found_text(header[0]) +
                ", expected commas between columns, and points in numbers, as 0.5");
        throw SceneFileError(
            place + ": header: found no " + (lacking > 1 ? "columns " : "column ") + absent +
            (header.size() > 12 ? "" : " among " + list_of({header.begin(), header.end()})));
    }

    // first: the number in the row's first column
    void read(const std::vector<std::string_view>& cells, const Found& found, const ColumnTo& c,
              double& first) const {
        const std::string_view cell = found.at < cells.size() ? cells[found.at] : "";
        const auto check = [&](bool holds, const char* expected) {
            if (!holds)
                throw SceneFileError(place + ": " + found.name + ": found " + found_text(cell) +
                                     ", expected " + expected);
        };
        if (auto* const* words = std::get_if<std::vector<std::string>*>(&c.to)) {
            check(!cell.empty() && is_text(cell), "a word in UTF-8");
            return (*words)->emplace_back(cell), void();
        }
        auto* const* perhaps = std::get_if<std::vector<std::optional<double>>*>(&c.to);
        if (perhaps && cell.empty()) return (*perhaps)->emplace_back(), void();
        auto x = number_of(cell);
        check(x && c.column.range.holds(*x), c.column.range.says);
        if (found.in_si) x = found.in_si(*x, first);
        check(std::isfinite(*x), positive.says);
        if (std::isnan(first)) first = *x;
        if (perhaps) (*perhaps)->push_back(x);
        else std::get<std::vector<double>*>(c.to)->push_back(*x);
    }
};
}  // namespace

std::vector<int> read_columns(const std::string& path, const std::string& text,
                              std::span<const ColumnTo> columns) {
    std::vector<std::optional<Found>> places;
    std::vector<int> lines;
    int line = 0;
    for (std::size_t begin = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
         begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view one = trimmed(std::string_view(text).substr(begin, end - begin));
        const ColumnLine at{path + ":" + std::to_string(++line)};
        begin = end + 1;
        if (one.empty() || one.front() == '#') continue;
        const auto cells = cells_of(one);
        if (end == text.size())
            throw SceneFileError(at.place +
                                 ": found no end of the line, expected one behind each row. Is "
                                 "the file cut off?");
        if (places.empty()) {
            places = at.find(cells, columns);
            continue;
        }
        lines.push_back(line);
        double first = std::nan("");
        for (std::size_t k = 0; k < columns.size(); ++k)
            if (places[k]) at.read(cells, *places[k], columns[k], first);
    }
    if (!places.empty()) return lines;
    std::vector<std::string> names;
    for (const ColumnTo& c : columns)
        if (!c.may_lack) names.emplace_back(c.column.name);
    throw SceneFileError(path + ":1: found no header, expected the columns " + list_of(names));
}

namespace {
template <class Number, class Bits>
Number of_bits(Bits bits) {  // replaces std::bit_cast, missing from the Emscripten in Debian 12
    static_assert(sizeof(Number) == sizeof(Bits));
    Number x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

std::uint64_t little_endian(std::string_view bytes) {
    std::uint64_t n = 0;
    for (std::size_t k = bytes.size(); k-- > 0;) n = n << 8 | static_cast<unsigned char>(bytes[k]);
    return n;
}

// A RIFF WAVE file consists of chunks, each with a name, a size and a content. If a sample has
// fewer bits than its bytes hold (20 or 12, for example), the bits are at the top.
void samples_of(const std::string& path, std::string_view bytes, Pluck& p) {
    constexpr int pcm = 1, floating = 3, extensible = 0xfffe;
    const auto check = [&path](bool holds, const std::string& found) {
        if (!holds)
            throw SceneFileError(path + ": found " + found +
                                 ", expected a sound of one channel, of 16, 24 or 32 bit or "
                                 "floating point");
    };
    check(bytes.size() >= 12 && bytes.substr(0, 4) == "RIFF" && bytes.substr(8, 4) == "WAVE",
          "no RIFF WAVE file");
    std::string_view format, data;
    for (bytes.remove_prefix(12); bytes.size() >= 8;) {
        const std::string_view name = bytes.substr(0, 4);
        const std::size_t size = little_endian(bytes.substr(4, 4));
        bytes.remove_prefix(8);
        if (name == "fmt ") format = bytes.substr(0, size);
        if (name != "data") {
            bytes.remove_prefix(std::min(bytes.size(), size + size % 2));
            continue;
        }
        if (size > bytes.size())
            throw SceneFileError(path + ": found " + std::to_string(bytes.size()) +
                                 " bytes of samples, expected the " + std::to_string(size) +
                                 " that its header announces. Is the file cut off?");
        check(data.data() == nullptr, "two blocks of samples");
        data = bytes.substr(0, size);
        bytes.remove_prefix(std::min(bytes.size(), size + size % 2));
    }
    check(format.size() >= 16, "no format");
    const auto field = [&](std::size_t at, std::size_t n) {
        return little_endian(format.substr(at, n));
    };
    auto tag = field(0, 2);
    if (tag == extensible && format.size() >= 26) tag = field(24, 2);
    const std::uint64_t channels = field(2, 2), rate = field(4, 4), size = field(12, 2),
                        bits = field(14, 2);
    check(channels == 1, std::to_string(channels) + " channels");
    check(bits <= 8 * size && bits + 8 > 8 * size &&
              ((tag == pcm && size >= 2 && size <= 4) ||
               (tag == floating && (size == 4 || size == 8))),
          "samples of another kind");
    if (data.size() % size != 0)
        throw SceneFileError(path +
                             ": found a part of a sample at its end, expected whole ones. "
                             "Is the file cut off?");
    check(rate > 0, "no sample rate");
    for (std::size_t n = 0; n < data.size() / size; ++n) {
        const std::uint64_t sample = little_endian(data.substr(n * size, size));
        const auto whole = static_cast<std::int64_t>(sample << (64 - 8 * size));  // sign extended
        p.share.push_back(tag == pcm  ? std::ldexp(static_cast<double>(whole), -63)
                          : size == 8 ? of_bits<double>(sample)
                                      : of_bits<float>(static_cast<std::uint32_t>(sample)));
        p.time.push_back(static_cast<double>(n) / static_cast<double>(rate));
        check(std::isfinite(p.share.back()), "a sample that is no number");
    }
}
}  // namespace

void force_from(const std::string& path, const std::string& text, Pluck& p) {
    const ColumnTo columns[] = {{{"time_s", "time", not_negative}, &p.time},
                                {{"force_N", "newtons", any}, &p.share}};
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = lower(c);
    if (ending == ".wav" || text.starts_with("RIFF")) samples_of(path, text, p);
    else read_columns(path, text, columns);
    for (const double F : p.share) p.peak = std::max(p.peak, std::abs(F));
    if (p.time.size() < 2 || !(p.peak > 0))
        throw SceneFileError(path + ": found " + std::to_string(p.time.size()) +
                             " rows and a largest force of " + std::to_string(p.peak) +
                             " N, expected two rows at least and a force");
    for (double& F : p.share) F /= p.peak;
    p.amplitude = p.peak;
    p.start = p.time.front();
    p.duration = p.time.back() - p.start;
}

namespace {
constexpr const char* gauges = "gauges.csv";
constexpr const char *linear_density = "linear_density_kg_per_m",
                     *core_diameter = "core_diameter_m";
constexpr double inch = 0.0254;  // [m]
}  // namespace

std::vector<SoldString> sold_strings() {
    std::error_code error;
    std::vector<std::string> maker, series;
    std::vector<double> gauge, density;
    std::vector<std::optional<double>> core;
    const ColumnTo columns[] = {{{"maker", "maker", any}, &maker},
                                {{"series", "series", any}, &series},
                                {{"gauge_in", "gauge_in", positive}, &gauge},
                                {{linear_density, linear_density, positive}, &density},
                                {{core_diameter, core_diameter, positive}, &core}};
    std::string text;
    if (!std::filesystem::exists(gauges, error)) text = library_text(gauges);
    else if (!std::filesystem::is_regular_file(gauges, error))
        throw SceneFileError(std::string(gauges) +
                             " of this folder is no file, expected a CSV file of strings, or none");
    else try {
            text = text_of_file(gauges, 1u << 20);
        } catch (const std::exception& e) {
            throw SceneFileError(std::string(gauges) + " " + e.what());
        }
    const std::vector<int> lines = read_columns(gauges, text, columns);
    std::vector<SoldString> strings;
    for (std::size_t k = 0; k < maker.size(); ++k) {
        if (core[k] && *core[k] > gauge[k] * inch * (1 + 1e-9))
            throw SceneFileError(std::string(gauges) + ":" + std::to_string(lines[k]) + ": " +
                                 core_diameter + ": found " + number_text(*core[k]) +
                                 ", expected at most the string's own, " +
                                 number_text(gauge[k] * inch));
        strings.push_back({maker[k], series[k], gauge[k], density[k], core[k]});
    }
    return strings;
}

SoldString sold_string(const std::vector<SoldString>& strings, const std::string& series,
                       double diameter) {
    const double wanted = diameter / inch;
    const SoldString *thinner = nullptr, *thicker = nullptr;
    for (const SoldString& s : strings) {
        if (s.series != series) continue;
        if (std::abs(s.gauge - wanted) < 1e-4) return s;
        const SoldString*& nearest = s.gauge < wanted ? thinner : thicker;
        if (!nearest || std::abs(s.gauge - wanted) < std::abs(nearest->gauge - wanted))
            nearest = &s;
    }
    std::string near;
    for (const SoldString* s : {thinner, thicker})
        if (s) near += (near.empty() ? "" : " and ") + number_text(s->gauge) + " in";
    throw SceneFileError(std::string(gauges) + ": found no " + quote(series) + " of " +
                         number_text(std::round(wanted * 1e5) / 1e5) + " in; the nearest: " + near);
}

}  // namespace jvari
