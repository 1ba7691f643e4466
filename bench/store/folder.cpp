#include "bench/store/folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
[[noreturn]] void refuse(const Folder& folder, const std::string& file, const char* why) {
    throw UsageError(fmt::format("{}/{}: {}", folder.path.string(), file, why));
}

std::optional<std::string> content(const fs::path& file) {  // nothing where there is none
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return std::nullopt;
    return read_whole(file);
}

Table with_rows(const Folder& folder, const std::string& file) {
    Table t = folder.table(file);
    if (!t.columns.empty() && t.rows.empty())
        refuse(folder, file + ".csv", "it has no row below its header; make the results again");
    return t;
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

Table Folder::cells(bool whole) const {
    Table cells = with_rows(*this, "cells");
    if (!cells.columns.empty()) return cells;
    cells = with_rows(*this, "errors");
    const Table cost = table("cost");
    std::map<std::string, std::size_t> by_cell;
    for (std::size_t i = 0; i < cost.rows.size(); ++i) by_cell[cost.at(i, "cell")] = i;
    // of cost, one for each row; as many as there are where none is its own
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {
        const auto found = by_cell.find(cells.at(i, "cell"));
        const std::size_t row = cost.column("cell") < 0  ? i
                                : found == by_cell.end() ? cost.rows.size()
                                                         : found->second;
        const bool same = row < cost.rows.size() &&
                          cost.at(row, "scheme") == cells.at(i, "scheme") &&
                          cost.at(row, "rate") == cells.at(i, "rate");
        rows.push_back(same ? row : cost.rows.size());
    }
    if (whole && std::ranges::count(rows, cost.rows.size()) !=
                     static_cast<long>(cells.rows.size()) - static_cast<long>(cost.rows.size()))
        refuse(*this, "cost.csv", "its rows are not those of errors.csv, run by run");
    for (const std::string& column : cost.columns) {
        if (cells.column(column) >= 0) continue;
        cells.columns.push_back(column);
        for (std::size_t i = 0; i < rows.size(); ++i)
            cells.rows[i].push_back(rows[i] < cost.rows.size() ? cost.at(rows[i], column) : "");
    }
    return cells;
}

}  // namespace jvari::bench::store
