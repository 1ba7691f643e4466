#include "bench/diff/difference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::diff {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;

Provenance provenance_of(const store::Folder& folder) {
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

std::string counted(std::map<std::string, int>& seen, const std::string& text) {
    const int n = ++seen[text];
    return n == 1 ? text : fmt::format("{} #{}", text, n);
}

std::string cell_text(const study::TabledCell& c) {
    std::string text = c.scene;
    for (const auto& [key, value] : c.swept) text += " " + key + "=" + value;
    text += " " + c.variant();
    return text + (std::isnan(c.rate) ? "" : " " + store::text_of(c.rate) + " Hz");
}
}  // namespace

std::string Provenance::machine() const {
    return fmt::format("{}, {} cores, {}, {}", cpu, cores, vectors, system);
}

Folder read_folder(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error))
        throw store::UsageError(fmt::format("{}: no such folder", path.string()));
    const store::Folder folder{path};
    const Folder f{path.string(),        provenance_of(folder),      study::read_cells(path, false),
                   folder.table("maps"), folder.table("boundaries"), folder.table("cells")};
    if (f.cells.empty() && f.maps.columns.empty())
        throw store::UsageError(fmt::format("{}: neither facts.csv nor maps.csv", f.name));
    return f;
}

std::vector<Finding> altered(const Folder& f) {
    if (f.shown.columns.empty()) return {};
    std::vector<Finding> all;
    const auto add = [&](const std::string& cell, const std::string& column,
                         const std::string& follows, const std::string& found) {
        all.push_back({Turn::worse, f.name + "/cells.csv " + cell, column, follows, found,
                       "altered: it follows from the other files"});
    };
    const store::Table follows = study::table_of(f.cells, study::Contents::cells);
    if (f.shown.rows.size() != follows.rows.size()) {
        add("", "rows", std::to_string(follows.rows.size()), std::to_string(f.shown.rows.size()));
        return all;
    }
    for (const std::string& column : follows.columns) {
        if (f.shown.column(column) < 0) {
            add("", column, "there", "gone");
            continue;
        }
        for (std::size_t i = 0; i < f.cells.size(); ++i)
            if (const std::string& is = f.shown.at(i, column), &was = follows.at(i, column);
                is != was && !(store::number_of(is) == store::number_of(was)))
                add(cell_text(f.cells[i]), column, was, is);
    }
    return all;
}

bool modes_name(const study::Cells& cells) {
    std::map<std::string, int> seen;
    return std::ranges::any_of(
        cells, [&seen](const study::TabledCell& c) { return ++seen[cell_text(c)] > 1; });
}

Named named_cells(const study::Cells& cells, bool with_modes) {
    Named named;
    std::map<std::string, int> seen;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double modes = cells[i].modes;
        named[counted(seen, cell_text(cells[i]) + (with_modes && !std::isnan(modes)
                                                       ? fmt::format(", {} modes", modes)
                                                       : ""))] = i;
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
