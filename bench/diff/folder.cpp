#include "bench/diff/folder.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/store/cell_rows.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::diff {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;

Made made_by(const store::Folder& folder) {
    const Json m = folder.manifest();
    const auto text = [&](const char* key) {
        const auto found = m.find(key);
        return found == m.end()     ? "unknown"
               : found->is_string() ? found->get<std::string>()
                                    : found->dump();
    };
    return {text("commit"), text("date"),  text("compiler"), text("flags"), text("build"),
            text("cpu"),    text("cores"), text("vectors"),  text("system")};
}

// Errors stand in cells.csv and in errors.csv: a folder in which they differ was changed by hand.
std::string altered_column(const store::Table& cells, const store::Table& errors) {
    const auto same = [&](const std::string& column) {
        for (std::size_t i = 0; i < errors.rows.size(); ++i)
            if (i >= cells.rows.size() || cells.at(i, column) != errors.at(i, column)) return false;
        return true;
    };
    for (const std::string& column : errors.columns)
        if (cells.column(column) >= 0 && !same(column)) return column;
    return "";
}

std::string counted(std::map<std::string, int>& seen, const std::string& text) {
    const int n = ++seen[text];
    return n == 1 ? text : fmt::format("{} #{}", text, n);
}

std::string cell_text(const store::Table& t, std::size_t row,
                      const std::vector<std::string>& names) {
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

Folder read_folder(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error))
        throw store::UsageError(fmt::format("{}: no such folder", path.string()));
    const store::Folder folder{path};
    Folder f{path.string(),
             made_by(folder),
             folder.cells(false),
             folder.table("dispersion"),
             folder.table("maps"),
             folder.table("boundaries"),
             ""};
    f.altered = altered_column(f.cells, folder.table("errors"));
    if (f.cells.columns.empty() && f.maps.columns.empty())
        throw store::UsageError(
            fmt::format("{}: neither cells.csv nor errors.csv nor maps.csv", f.name));
    return f;
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
        const std::string modes = with_modes && !cells.at(i, "modes").empty()
                                      ? ", " + cells.at(i, "modes") + " modes"
                                      : "";
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
