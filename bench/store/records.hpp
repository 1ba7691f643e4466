// Results are rows: a table of fields with named columns, written and read as CSV (RFC 4180) and
// as JSON. Fields keep their types in CSV: a text that looks like a number has quotation
// marks. A spreadsheet would take a text that begins with = + - @ and is no number for a formula,
// so the file puts an apostrophe in front. Texts that begin with an apostrophe get another one.
#pragma once

#include <concepts>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "schemes/trace.hpp"

namespace jvari::bench::store {

// Shortest text that reads back as the same number; "" for NaN, "inf" for an infinity.
std::string text_of(double);
double number_of(const std::string&);  // NaN for "" and for any text that is no number

// Options of a scheme: name, value.
using Options = std::vector<std::pair<std::string, std::string>>;
// "control=none tolerance=1e-9"
std::string options_text(const Options&);
Options options_in(const std::string& text);  // reads options_text
// "sitar_fdm control=none", or the scheme alone
std::string variant_name(const std::string& scheme, const std::string& options);

// Field of a table: a number, a truth value or a text. Its type decides the form in JSON. Equal
// fields have the same text in CSV.
class Field {
public:
    Field(double x = nan) : content_(x) {}  // NaN: blank
    template <std::integral Whole>
    Field(Whole n) : content_(static_cast<double>(n)) {}
    Field(bool holds) : content_(holds) {}  // CSV has "1" or "0"
    Field(std::string text) : content_(std::move(text)) {}
    Field(const char* text) : content_(std::string(text)) {}
    // Number with the digits of a suite file, "1e+05"; a text if `digits` is no number.
    static Field as_written(std::string digits);
    static Field rounded(double x, int digits);  // significant digits; blank for an infinity

    std::string text() const;  // "" for a blank
    double number() const;     // NaN for a blank, and for a text that is no number
    bool empty() const { return text().empty(); }
    nlohmann::ordered_json json() const;  // null for a blank and for an infinity
    std::string csv() const;
    friend bool operator==(const Field& a, const Field& b) { return a.text() == b.text(); }

private:
    struct Digits {
        std::string text;
    };
    std::variant<double, bool, std::string, Digits> content_;
};

struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<Field>> rows;

    int column(const std::string& name) const;  // -1: absent
    // blank for an absent column
    const Field& at(std::size_t row, const std::string& name) const;
    std::string text(std::size_t row, const std::string& name) const {
        return at(row, name).text();
    }
    double number(std::size_t row, const std::string& name) const { return at(row, name).number(); }
    // Selects columns in the given order; absent ones are left out.
    Table only(const std::vector<std::string>& names) const;
};

std::string quoted(const std::string& text);     // CSV form
nlohmann::ordered_json rows_json(const Table&);  // one object per row
// {"columns": [...], "rows": [[...], ...]}. JSON has no infinity: it stands as [1] or [-1].
nlohmann::ordered_json table_json(const Table&);
Table table_in(const nlohmann::ordered_json&);  // reads table_json
std::string csv(const Table&);
// Reads a number from each field without quotation marks that has one. Throws std::runtime_error
// with the line if a row has too few or too many fields.
Table read_csv(const std::string& text);

// A folder of results: its manifest and its tables, from manifest.json and NAME.csv. A folder
// without manifest.json has both in results.json. An unreadable file throws UsageError with the
// folder's name, the file and the reason.
class Folder {
public:
    explicit Folder(std::filesystem::path);

    const std::filesystem::path path;
    const nlohmann::ordered_json& manifest() const { return *manifest_; }
    Table table(const std::string& name) const;        // empty if there is none
    std::string file(const std::string& table) const;  // where it stands
    bool is_one_file() const { return tables_ != nullptr; }

private:
    // tables_: those of results.json, nullptr where it is not read
    std::shared_ptr<const nlohmann::ordered_json> manifest_, tables_;
};

}  // namespace jvari::bench::store
