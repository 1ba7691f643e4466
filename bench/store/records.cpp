#include "bench/store/records.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::store {

std::string text_of(double x) {
    if (std::isnan(x)) return "";
    return fmt::format("{}", x);
}

double number_of(const std::string& text) { return jvari::number_of(text).value_or(nan); }

std::string options_text(const Options& options) {
    std::string text;
    for (const auto& [name, value] : options)
        text += (text.empty() ? "" : " ") + name + "=" + value;
    return text;
}

Options options_in(const std::string& text) {
    Options options;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ' ');) {
        const auto equals = std::min(word.find('='), word.size());
        // a value may have a space: the path of a file
        if (equals == word.size() && !options.empty()) options.back().second += " " + word;
        else
            options.emplace_back(word.substr(0, equals),
                                 word.substr(std::min(equals + 1, word.size())));
    }
    return options;
}

std::string variant_name(const std::string& scheme, const std::string& options) {
    return options.empty() ? scheme : scheme + " " + options;
}

// ---- Fields

Field Field::as_written(std::string digits) {
    Field v(std::move(digits));
    if (!std::isnan(v.number())) v.content_ = Digits{v.text()};
    return v;
}

Field Field::rounded(double x, int digits) {
    return std::isfinite(x) ? as_written(fmt::format("{:.{}g}", x, digits)) : Field();
}

std::string Field::text() const {
    if (const auto* x = std::get_if<double>(&content_)) return text_of(*x);
    if (const auto* holds = std::get_if<bool>(&content_)) return *holds ? "1" : "0";
    if (const auto* digits = std::get_if<Digits>(&content_)) return digits->text;
    return std::get<std::string>(content_);
}

double Field::number() const {
    const auto* x = std::get_if<double>(&content_);
    return x ? *x : number_of(text());
}

nlohmann::ordered_json Field::json() const {
    if (const auto* words = std::get_if<std::string>(&content_)) return *words;
    if (const auto* holds = std::get_if<bool>(&content_)) return *holds;
    const double x = number();
    // JSON of a count: 532, where a double would have 532.0
    constexpr double most_digits = 1e16;
    if (!std::signbit(x) && x < most_digits && x == std::floor(x)) return static_cast<long>(x);
    return x;
}

// ---- Tables

int Table::column(const std::string& name) const {
    const auto found = std::find(columns.begin(), columns.end(), name);
    return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

const Field& Table::at(std::size_t row, const std::string& name) const {
    static const Field nothing;
    const int k = column(name);
    return k < 0 ? nothing : rows.at(row).at(k);
}

Table Table::only(const std::vector<std::string>& names) const {
    Table part;
    std::vector<int> from;
    for (const std::string& name : names)
        if (const int k = column(name); k >= 0) {
            part.columns.push_back(name);
            from.push_back(k);
        }
    for (const auto& row : rows) {
        part.rows.emplace_back();
        for (int k : from) part.rows.back().push_back(row.at(k));
    }
    return part;
}

namespace {
bool is_marked(const std::string& field) {  // marked field in a file: "'=1+1"
    return field.size() > 1 && field[0] == '\'' &&
           std::string_view("=+-@'\t").find(field[1]) != std::string_view::npos;
}
}  // namespace

std::string quoted(const std::string& plain) {
    const bool mark = is_marked("'" + plain) && std::isnan(number_of(plain));
    const std::string field = mark ? "'" + plain : plain;
    if (field.find_first_of(",\"\r\n") == std::string::npos && !field.starts_with(byte_order_mark))
        return field;
    std::string text = "\"";
    for (char c : field) text += c == '"' ? "\"\"" : std::string(1, c);
    return text + '"';
}

std::string csv(const Table& table) {
    std::string text;
    for (std::size_t k = 0; k < table.columns.size(); ++k)
        text += (k ? "," : "") + quoted(table.columns[k]);
    text += '\n';
    for (const auto& row : table.rows) {
        for (std::size_t k = 0; k < row.size(); ++k) text += (k ? "," : "") + quoted(row[k].text());
        text += '\n';
    }
    return text;
}

Table read_csv(const std::string& text) {
    Table table;
    std::vector<std::string> fields{""};
    bool inside = false, begun = false;
    const std::size_t start = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    int line = 1;
    const auto end_row = [&] {
        if (!begun) return;  // an empty line
        for (std::string& field : fields)
            if (is_marked(field)) field.erase(0, 1);
        if (table.columns.empty()) {
            table.columns = fields;
            std::ranges::sort(fields);
            if (const auto twice = std::ranges::adjacent_find(fields); twice != fields.end())
                throw std::runtime_error(
                    fmt::format("line 1: found two columns {}, expected one", found_text(*twice)));
        } else if (fields.size() != table.columns.size()) {
            throw std::runtime_error(fmt::format("line {}: found {} fields, expected {}", line,
                                                 fields.size(), table.columns.size()));
        } else {
            table.rows.emplace_back(std::make_move_iterator(fields.begin()),
                                    std::make_move_iterator(fields.end()));
        }
        fields.assign(1, "");
        begun = false;
    };
    for (std::size_t i = start; i < text.size(); ++i) {
        const char c = text[i];
        if (inside) {
            if (c != '"') fields.back() += c;
            else if (i + 1 < text.size() && text[i + 1] == '"') fields.back() += text[++i];
            else inside = false;
        } else if (c == '"') {
            inside = begun = true;
        } else if (c == ',') {
            fields.emplace_back();
            begun = true;
        } else if (c == '\n') {
            end_row();
            ++line;
        } else if (c != '\r') {
            fields.back() += c;
            begun = true;
        }
    }
    if (inside)
        throw std::runtime_error(fmt::format("line {}: a quotation mark is not closed", line));
    end_row();
    return table;
}

nlohmann::ordered_json rows_json(const Table& table) {
    auto rows = nlohmann::ordered_json::array();
    for (const auto& row : table.rows) {
        auto j = nlohmann::ordered_json::object();
        for (std::size_t k = 0; k < row.size(); ++k) j[table.columns[k]] = row[k].json();
        rows.push_back(std::move(j));
    }
    return rows;
}

namespace fs = std::filesystem;

namespace {
[[noreturn]] void refuse(const Folder& folder, const std::string& file, const char* why) {
    throw UsageError(fmt::format("{}/{}: {}", folder.path.string(), file, why));
}

std::optional<std::string> content(const fs::path& file) {  // nothing for a missing file
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return std::nullopt;
    return read_whole(file);
}
}  // namespace

nlohmann::ordered_json Folder::manifest() const {
    const auto text = content(path / "manifest.json");
    if (!text)
        throw UsageError(path.string() +
                         ": no manifest.json, expected a folder that compare, suite or trim wrote");
    try {
        auto m = parsed(*text);
        return m.is_object() ? m : throw std::runtime_error("it holds no object");
    } catch (const std::exception& e) { refuse(*this, "manifest.json", e.what()); }
}

Table Folder::table(const std::string& file) const {
    const auto text = content(path / (file + ".csv"));
    if (!text) return {};
    try {
        return read_csv(as_utf8(*text));
    } catch (const std::exception& e) { refuse(*this, file + ".csv", e.what()); }
}

}  // namespace jvari::bench::store
