// Results are rows: a table of text with named columns, and CSV (RFC 4180) to and fro. A text that
// a spreadsheet would take for a formula, because it begins with = + - @ and is no number, has an
// apostrophe in front in the file; so has one that begins with an apostrophe.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "schemes/trace.hpp"

namespace jvari::bench::store {

// A number as the shortest text that reads back as itself; "" for NaN, "inf" for an infinity.
std::string text_of(double);
double number_of(const std::string&);  // NaN for "" and for what is no number

// of a scheme: name, value
using Options = std::vector<std::pair<std::string, std::string>>;
// "control=none tolerance=1e-9"
std::string options_text(const Options&);
// "sitar_fdm control=none", or the scheme alone
std::string variant_name(const std::string& scheme, const std::string& options);

struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;

    int column(const std::string& name) const;  // -1: absent
    // "" where the column is absent
    const std::string& at(std::size_t row, const std::string& name) const;
    double number(std::size_t row, const std::string& name) const {
        return number_of(at(row, name));
    }
    // those columns, in that order; absent ones are left out
    Table only(const std::vector<std::string>& names) const;
};

std::string quoted(const std::string& field);    // as CSV writes it
nlohmann::ordered_json rows_json(const Table&);  // one object per row, numbers as numbers
std::string csv(const Table&);
// throws std::runtime_error with the line where a row has too few or too many fields
Table read_csv(const std::string& text);

// A folder of results: its manifest and its tables. What cannot be read throws UsageError with the
// folder's name, the file and why.
struct Folder {
    std::filesystem::path path;

    nlohmann::ordered_json manifest() const;
    Table table(const std::string& file) const;  // FILE.csv; empty where there is none
};

}  // namespace jvari::bench::store
