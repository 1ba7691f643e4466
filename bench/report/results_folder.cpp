#include "bench/report/results_folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/compare/bound.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/compare_record.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/report/report.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::report {

namespace {
namespace fs = std::filesystem;

constexpr const char* own_folders[] = {"cells", "points", "sounds", "failures", "references"};
constexpr const char* own_endings[] = {".csv", ".json", ".svg", ".pdf", ".html", ".toml", ".part"};

std::string what_is_in(const fs::path& folder) {  // "" where that is unknown
    try {
        const auto m = store::Folder{folder}.manifest();
        if (m.contains("suite")) {
            const std::string name = m.at("suite");
            return name.starts_with("trim ") ? "trim of " + name.substr(5) : "suite " + name;
        }
        return "comparison of " + m.at("scene").at("name").get<std::string>();
    } catch (const std::exception&) { return ""; }
}
}  // namespace

void must_be_ours(const fs::path& folder, const std::string& what,
                  const store::Listener& listener) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return;
    if (const std::string there = what_is_in(folder); !there.empty() && there != what)
        throw store::UsageError(
            fmt::format("--out {}: this folder holds the {}, and this is the {}; choose another "
                        "folder, or empty it",
                        folder.string(), there, what));
    std::vector<std::string> foreign;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename(), extension = entry.path().extension();
        const bool own = entry.is_directory(error)
                             ? std::find(std::begin(own_folders), std::end(own_folders), name) !=
                                   std::end(own_folders)
                             : std::find(std::begin(own_endings), std::end(own_endings),
                                         extension) != std::end(own_endings);
        if (!own && !name.starts_with(".")) foreign.push_back(name);
    }
    std::sort(foreign.begin(), foreign.end());
    if (foreign.empty()) return;
    std::string names;
    for (std::size_t k = 0; k < std::min<std::size_t>(foreign.size(), 5); ++k)
        names += (k > 0 ? ", " : "") + foreign[k];
    listener.note(fmt::format(
        "{} holds what is not of a {}: {}{}", folder.string(), what.substr(0, what.find(' ')),
        names, foreign.size() > 5 ? fmt::format(" and {} more", foreign.size() - 5) : ""));
}

fs::path cells_folder(const fs::path& folder, const std::string& what,
                      const store::Listener& listener) {
    if (folder.empty()) return folder;
    must_be_ours(folder, what, listener);
    store::make_folder(folder / "cells");
    store::must_be_writable(folder / "cells.csv");
    store::must_be_writable(folder / "cells" / "any.json");
    for (const char* own : own_folders) store::sweep_parts(folder / own);
    return folder / "cells";
}

void ResultsFolder::add(const std::string& name, const std::string& content) {
    if (folder_.empty()) return;
    store::write_fresh(folder_ / name, content);
    files.push_back((folder_ / name).string());
}

void ResultsFolder::add_tables(const study::Cells& cells) {
    using study::Contents;
    add("cells.csv", store::csv(study::table_of(cells, Contents::cells)));
    add("facts.csv", store::csv(study::table_of(cells, Contents::facts)));
    add("errors.csv", store::csv(study::errors_table(cells)));
    add("cost.csv", store::csv(study::table_of(cells, Contents::cost)));
    if (const store::Table orders = compare::convergence_table(cells); !orders.rows.empty())
        add("convergence.csv", store::csv(orders));
}

void ResultsFolder::add_manifest(const nlohmann::ordered_json& manifest) {
    add("manifest.json", store::indented(manifest) + "\n");
}

void ResultsFolder::add_report() {
    if (folder_.empty()) return;
    for (const std::string& name : write_report(folder_, listener_))
        files.push_back((folder_ / name).string());
}

Written written(const compare::Comparison& c, const compare::CompareRequest& request,
                const store::Listener& listener) {
    Written r{compare::manifest_of(c, request), compare::cells_of(c), {}, {}};
    r.cheapest = compare::cheapest_of(
        r.cells, request.controls ? compare::Controls::compete : compare::Controls::stand_beside);
    ResultsFolder folder(request.out, listener);
    folder.add_tables(r.cells);
    folder.add_manifest(r.manifest);
    if (folder) compare::write_sounds(c, request.out);
    folder.add_report();
    r.files = std::move(folder.files);
    return r;
}

}  // namespace jvari::bench::report
