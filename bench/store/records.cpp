#include "bench/store/records.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
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

std::string variant_name(const std::string& scheme, const std::string& options) {
    return options.empty() ? scheme : scheme + " " + options;
}

int Table::column(const std::string& name) const {
    const auto found = std::find(columns.begin(), columns.end(), name);
    return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

const std::string& Table::at(std::size_t row, const std::string& name) const {
    static const std::string nothing;
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
    const auto line = [&text](const std::vector<std::string>& fields) {
        for (std::size_t k = 0; k < fields.size(); ++k) text += (k ? "," : "") + quoted(fields[k]);
        text += '\n';
    };
    line(table.columns);
    for (const auto& row : table.rows) line(row);
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
            table.rows.push_back(fields);
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
    static const std::set<std::string> texts{
        "scheme",       "status",  "reason",    "flags",   "below_floor", "cell",
        "scene",        "options", "reference", "measure", "ties",        "run",
        "as_published", "perhaps", "why",       "machine", "governor"};
    auto rows = nlohmann::ordered_json::array();
    for (const auto& row : table.rows) {
        auto j = nlohmann::ordered_json::object();
        for (std::size_t k = 0; k < row.size(); ++k) {
            const std::string& name = table.columns[k];
            const bool digits = !row[k].empty() && row[k].size() < 18 &&
                                row[k].find_first_not_of("0123456789") == std::string::npos;
            const double x = number_of(row[k]);
            if (name == "pareto") j[name] = row[k] == "1";
            else if (texts.contains(name) || (std::isnan(x) && !row[k].empty())) j[name] = row[k];
            else if (digits) j[name] = std::stol(row[k]);
            else j[name] = x;  // "" and infinities become null
        }
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
