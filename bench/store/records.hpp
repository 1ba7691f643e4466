// Results are rows: a table of text with named columns, written and read as CSV (RFC 4180). A
// spreadsheet would take a text that begins with = + - @ and is no number for a formula, so the
// file puts an apostrophe in front. Texts that begin with an apostrophe get another one.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
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
// "sitar_fdm control=none", or the scheme alone
std::string variant_name(const std::string& scheme, const std::string& options);

struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;

    int column(const std::string& name) const;  // -1: absent
    // "" for an absent column
    const std::string& at(std::size_t row, const std::string& name) const;
    double number(std::size_t row, const std::string& name) const {
        return number_of(at(row, name));
    }
    // Selects columns in the given order; absent ones are left out.
    Table only(const std::vector<std::string>& names) const;
};

std::string quoted(const std::string& field);    // CSV form
nlohmann::ordered_json rows_json(const Table&);  // one object per row, numbers as numbers
std::string csv(const Table&);
// Throws std::runtime_error with the line if a row has too few or too many fields.
Table read_csv(const std::string& text);

// A folder of results: its manifest and its tables. An unreadable file throws UsageError with the
// folder's name, the file and the reason.
struct Folder {
    std::filesystem::path path;

    nlohmann::ordered_json manifest() const;
    Table table(const std::string& file) const;  // FILE.csv; empty if there is none
};

}  // namespace jvari::bench::store
