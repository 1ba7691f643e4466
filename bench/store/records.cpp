#include "bench/store/records.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

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
    if (!std::isfinite(x)) return nullptr;
    // JSON of a count: 532, where a double would have 532.0
    constexpr double most_digits = 1e16;
    if (!std::signbit(x) && x < most_digits && x == std::floor(x)) return static_cast<long>(x);
    return x;
}

std::string Field::csv() const {
    const auto* words = std::get_if<std::string>(&content_);
    if (!words) return text();
    return std::isnan(number()) ? quoted(*words) : '"' + *words + '"';
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
        for (std::size_t k = 0; k < row.size(); ++k) text += (k ? "," : "") + row[k].csv();
        text += '\n';
    }
    return text;
}

namespace {
struct CsvField {  // field as a file has it
    std::string text;
    bool quoted = false;
};

void add_row(Table& table, std::vector<CsvField> fields, int line) {
    for (CsvField& f : fields)
        if (is_marked(f.text)) f.text.erase(0, 1), f.quoted = true;
    if (table.columns.empty()) {
        for (const CsvField& f : fields) table.columns.push_back(f.text);
        auto names = table.columns;
        std::ranges::sort(names);
        if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
            throw std::runtime_error(
                fmt::format("line 1: found two columns {}, expected one", found_text(*twice)));
        return;
    }
    if (fields.size() != table.columns.size())
        throw std::runtime_error(fmt::format("line {}: found {} fields, expected {}", line,
                                             fields.size(), table.columns.size()));
    auto& row = table.rows.emplace_back();
    for (CsvField& f : fields)
        row.push_back(f.text.empty() ? Field()
                      : f.quoted     ? Field(std::move(f.text))
                                     : Field::as_written(std::move(f.text)));
}
}  // namespace

Table read_csv(const std::string& text) {
    Table table;
    std::vector<CsvField> fields(1);
    bool inside = false, begun = false;
    const std::size_t start = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    int line = 1;
    const auto end_row = [&] {
        if (begun) add_row(table, std::exchange(fields, std::vector<CsvField>(1)), line);
        begun = false;  // else an empty line
    };
    for (std::size_t i = start; i < text.size(); ++i) {
        const char c = text[i];
        CsvField& last = fields.back();
        if (c == '\n' && !inside) {
            end_row();
            ++line;
            continue;
        }
        begun = begun || c != '\r';
        if (inside) {
            if (c != '"') last.text += c;
            else if (i + 1 < text.size() && text[i + 1] == '"') last.text += text[++i];
            else inside = false;
        } else if (c == '"') {
            inside = last.quoted = true;
        } else if (c == ',') {
            fields.emplace_back();
        } else if (c != '\r') {
            last.text += c;
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

nlohmann::ordered_json table_json(const Table& table) {
    auto rows = nlohmann::ordered_json::array();
    for (const auto& row : table.rows) {
        auto& fields = rows.emplace_back(nlohmann::ordered_json::array());
        for (const Field& field : row) {
            fields.push_back(field.json());
            if (fields.back().is_null() && std::isinf(field.number()))
                fields.back().push_back(field.number() > 0 ? 1 : -1);
        }
    }
    return {{"columns", table.columns}, {"rows", std::move(rows)}};
}

Table table_in(const nlohmann::ordered_json& j) {
    Table table;
    j.at("columns").get_to(table.columns);
    for (const auto& row : j.at("rows")) {
        auto& fields = table.rows.emplace_back();
        for (const auto& field : row)
            if (field.is_string()) fields.emplace_back(field.get<std::string>());
            else if (field.is_boolean()) fields.emplace_back(field.get<bool>());
            else if (field.is_number())
                fields.push_back(Field::as_written(number_text(field.get<double>())));
            else if (field.is_array()) fields.emplace_back(HUGE_VAL * field.at(0).get<double>());
            else fields.emplace_back();
        if (fields.size() != table.columns.size())
            throw std::runtime_error(fmt::format("row {}: found {} fields, expected {}",
                                                 table.rows.size(), fields.size(),
                                                 table.columns.size()));
    }
    return table;
}

namespace fs = std::filesystem;

namespace {

std::optional<std::string> content(const fs::path& file) {  // nothing for a missing file
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return std::nullopt;
    return read_whole(file);
}

template <class Read>
auto naming(const fs::path& file, Read read) {  // the file in the message of a failure
    try {
        return read();
    } catch (const std::exception& e) {
        throw UsageError(fmt::format("{}: {}", file.string(), e.what()));
    }
}

std::shared_ptr<const nlohmann::ordered_json> object(nlohmann::ordered_json j) {
    if (!j.is_object()) throw std::runtime_error("it holds no object");
    return std::make_shared<const nlohmann::ordered_json>(std::move(j));
}
}  // namespace

Folder::Folder(fs::path folder) : path(std::move(folder)) {
    const auto parse = [this](const char* name, auto read) {
        naming(path / name, [&] {
            if (const auto text = content(path / name)) read(parsed(*text));
        });
    };
    parse("manifest.json", [this](const auto& j) { manifest_ = object(j); });
    if (!manifest_)
        parse("results.json", [this](const auto& values) {
            manifest_ = object(values.at("manifest"));
            tables_ = object(values.at("tables"));
        });
    if (!manifest_)
        throw UsageError(path.string() +
                         ": neither manifest.json nor results.json, expected a folder that "
                         "compare, suite or trim wrote");
}

std::string Folder::file(const std::string& table) const {
    return (path / (tables_ ? "results.json" : table + ".csv")).string();
}

Table Folder::table(const std::string& name) const {
    return naming(file(name), [&]() -> Table {
        if (tables_) return tables_->contains(name) ? table_in(tables_->at(name)) : Table();
        const auto text = content(file(name));
        return text ? read_csv(as_utf8(*text)) : Table();
    });
}

}  // namespace jvari::bench::store
