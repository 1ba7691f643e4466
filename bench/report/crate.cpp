#include "bench/report/crate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "bench/store/folder.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"

namespace jvari::bench::report {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;

Json id(const std::string& of) {
    return {{"@id", of}};
}

struct Kind {
    const char *extension, *format, *is;
};
constexpr Kind kinds[] = {{".csv", "text/csv", "a table of results: `jvari list columns` explains its columns"},
                          {".json", "application/json", "what the results were made by"},
                          {".svg", "image/svg+xml", "a picture"},
                          {".pdf", "application/pdf", "a picture"},
                          {".html", "text/html", "the report"},
                          {".toml", "application/toml", "a scene or a suite"},
                          {".py", "text/x-python", "draws the tables"}};

Json part_of(const fs::path& file) {
    const std::string name = file.filename().string();
    if (fs::is_directory(file)) return {{"@id", name + "/"}, {"@type", "Dataset"}, {"name", name}};
    Json part{{"@id", name}, {"@type", "File"}, {"name", name}};
    for (const Kind& k : kinds)
        if (file.extension() == k.extension) part["encodingFormat"] = k.format, part["description"] = k.is;
    return part;
}

// Sorted; without the crate itself, and what the program keeps for itself alone.
std::vector<fs::path> parts_of(const fs::path& folder) {
    std::vector<fs::path> parts;
    for (const auto& entry : fs::directory_iterator(folder))
        if (const std::string name = entry.path().filename(); name != crate_file && name != "references" && !name.starts_with("."))
            parts.push_back(entry.path());
    std::ranges::sort(parts);
    return parts;
}

Json authors() {
    Json all = Json::array();
    std::istringstream names(JVARI_AUTHORS);
    for (std::string name; std::getline(names, name, '|');)
        all.push_back({{"@id", fmt::format("#author-{}", all.size() + 1)}, {"@type", "Organization"}, {"name", name}});
    return all;
}
}  // namespace

std::string crate_of(const fs::path& folder) {
    const Json manifest = store::folder_at(folder).manifest();
    const auto text = [&manifest](const char* key) { return manifest.value(key, std::string()); };
    const bool of_a_scene = manifest.contains("scene") && manifest["scene"].is_object();
    const std::string name = of_a_scene ? manifest["scene"].value("name", "") : text("suite"),
                      source = of_a_scene ? manifest["scene"].value("source", "") : text("source"),
                      licence = std::string("https://spdx.org/licenses/") + JVARI_LICENCE;
    const Json people = authors();
    Json root{{"@id", "./"},
              {"@type", "Dataset"},
              {"name", fmt::format("jvari results: {}", name)},
              {"description", fmt::format("Errors and costs of numerical schemes for a string against an obstacle{}{}",
                                          source.empty() ? "" : "; after ", source)},
              {"datePublished", text("date")},
              {"license", id(licence)},
              {"author", Json::array()},
              {"hasPart", Json::array()}};
    for (const Json& one : people) root["author"].push_back(id(one["@id"]));
    Json graph{{{"@id", crate_file}, {"@type", "CreativeWork"}, {"conformsTo", id("https://w3id.org/ro/crate/1.1")}, {"about", id("./")}}};
    Json parts = Json::array();
    for (const fs::path& file : parts_of(folder)) {
        parts.push_back(part_of(file));
        root["hasPart"].push_back(id(parts.back()["@id"]));
    }
    graph.push_back(root);
    graph.insert(graph.end(), people.begin(), people.end());
    graph.insert(graph.end(), parts.begin(), parts.end());
    graph.push_back({{"@id", licence}, {"@type", "CreativeWork"}, {"name", JVARI_LICENCE}});
    graph.push_back({{"@id", "#jvari"}, {"@type", "SoftwareApplication"}, {"name", "jvari"}, {"version", text("commit")}});
    graph.push_back({{"@id", "#run"},
                     {"@type", "CreateAction"},
                     {"name", text("command")},
                     {"endTime", text("date")},
                     {"instrument", id("#jvari")},
                     {"result", id("./")}});
    return store::indented({{"@context", "https://w3id.org/ro/crate/1.1/context"}, {"@graph", graph}}) + "\n";
}

void write_crate(const fs::path& folder) {
    store::write_fresh(folder / crate_file, crate_of(folder));
}

}  // namespace jvari::bench::report
