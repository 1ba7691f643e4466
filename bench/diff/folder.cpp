#include "bench/diff/folder.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/store/cell_rows.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::diff {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;

store::Table table_of(const std::string& name, const std::string& file, const Contents& contents) {
    const auto text = contents(file);
    if (!text) return {};
    try {
        return store::read_csv(*text);
    } catch (const std::runtime_error& e) {
        throw store::UsageError(fmt::format("{}/{}: {}", name, file, e.what()));
    }
}

// Each row of `errors` with the costs of its cell behind it. Tables of compare do not name the cell: there the rows are the same.
store::Table joined(store::Table errors, const store::Table& cost) {
    std::map<std::string, std::size_t> by_cell;
    for (std::size_t i = 0; i < cost.rows.size(); ++i) by_cell[cost.at(i, "cell")] = i;
    const bool named = cost.column("cell") >= 0;
    for (const std::string& column : cost.columns) {
        if (errors.column(column) >= 0) continue;
        errors.columns.push_back(column);
        for (std::size_t i = 0; i < errors.rows.size(); ++i) {
            const auto found = by_cell.find(errors.at(i, "cell"));
            const std::size_t row = !named ? i : found == by_cell.end() ? cost.rows.size() : found->second;
            const bool same =
                row < cost.rows.size() && cost.at(row, "scheme") == errors.at(i, "scheme") && cost.at(row, "rate") == errors.at(i, "rate");
            errors.rows[i].push_back(same ? cost.at(row, column) : "");
        }
    }
    return errors;
}

Made made_by(const std::string& name, const std::string& manifest) {
    try {
        store::refuse_deep(manifest);
        const Json m = Json::parse(manifest);
        const auto text = [&m](const char* key) { return m.value(key, std::string("unknown")); };
        Made made{text("commit"), text("date"), text("compiler"), text("flags"), text("build"),
                  text("cpu"),    "",           text("vectors"),  text("system")};
        if (m.contains("cores")) made.cores = m["cores"].dump();
        return made;
    } catch (const std::exception& e) {  // Json::exception, what refuse_deep() throws
        throw store::UsageError(fmt::format("{}/manifest.json: {}", name, e.what()));
    }
}

std::string counted(std::map<std::string, int>& seen, const std::string& text) {
    const int n = ++seen[text];
    return n == 1 ? text : fmt::format("{} #{}", text, n);
}

std::string cell_text(const store::Table& t, std::size_t row, const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        const std::string& value = t.at(row, name);
        const bool plain = name == "scene" || name == "scheme" || name == "options";
        if (!value.empty()) text += (text.empty() ? "" : " ") + (plain ? "" : name + "=") + value;
    }
    return text + (t.at(row, "rate").empty() ? "" : " " + t.at(row, "rate") + " Hz");
}
}  // namespace

std::string Made::machine() const {
    return fmt::format("{}, {} cores, {}, {}", cpu, cores, vectors, system);
}

Folder read_folder(const std::string& name, const Contents& contents) {
    Folder f;
    f.name = name;
    const auto manifest = contents("manifest.json");
    if (!manifest) throw store::UsageError(fmt::format("{}: no manifest.json, expected a folder that compare or suite wrote", name));
    f.made = made_by(name, *manifest);
    f.cells = table_of(name, "cells.csv", contents);
    if (f.cells.columns.empty()) f.cells = joined(table_of(name, "errors.csv", contents), table_of(name, "cost.csv", contents));
    f.dispersion = table_of(name, "dispersion.csv", contents);
    f.maps = table_of(name, "maps.csv", contents);
    f.boundaries = table_of(name, "boundaries.csv", contents);
    if (f.cells.columns.empty() && f.maps.columns.empty())
        throw store::UsageError(fmt::format("{}: neither cells.csv nor errors.csv nor maps.csv", name));
    return f;
}

Folder read_folder(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) throw store::UsageError(fmt::format("{}: no such folder", path.string()));
    return read_folder(path.string(), [&path](const std::string& file) -> std::optional<std::string> {
        std::error_code ignored;
        if (!fs::is_regular_file(path / file, ignored)) return std::nullopt;
        return store::read_whole(path / file);
    });
}

bool modes_name(const store::Table& cells) {
    std::map<std::string, int> seen;
    const auto names = store::naming_columns(cells);
    for (std::size_t i = 0; i < cells.rows.size(); ++i)
        if (++seen[cell_text(cells, i, names)] > 1) return true;
    return false;
}

Named named_cells(const store::Table& cells, bool with_modes, bool with_scene) {
    Named named;
    std::map<std::string, int> seen;
    auto names = store::naming_columns(cells);
    if (!with_scene) std::erase(names, "scene");
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {
        const std::string modes = with_modes && !cells.at(i, "modes").empty() ? ", " + cells.at(i, "modes") + " modes" : "";
        named[counted(seen, cell_text(cells, i, names) + modes)] = i;
    }
    return named;
}

Named named_rows(const store::Table& t, const std::vector<std::string>& columns) {
    Named named;
    std::map<std::string, int> seen;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        std::string text;
        for (const std::string& name : columns)
            if (!t.at(i, name).empty()) text += (text.empty() ? "" : " ") + t.at(i, name);
        named[counted(seen, text)] = i;
    }
    return named;
}

}  // namespace jvari::bench::diff
