// Finds a scene, reads it, and adds file and line to error messages.
#include "scenes/scene_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "scenes/columns.hpp"
#include "scenes/document.hpp"
#include "scenes/installed.hpp"
#include "scenes/schema.hpp"
#include "scenes/wording.hpp"

namespace jvari {

namespace fs = std::filesystem;

namespace {
constexpr std::size_t largest_scene = 1u << 20;  // bytes

fs::path library() {
    const char* set = std::getenv("JVARI_SCENES");
    std::error_code error;
    for (const fs::path& directory :
         {fs::path(set ? set : ""), installed("scenes"), fs::path(JVARI_SOURCE_SCENES),
          fs::path(JVARI_INSTALLED_SCENES)})
        if (!directory.empty() && fs::is_directory(directory, error)) return directory;
    return {};
}

// "scenes/a.toml" and "./a" are files; "a" is a file too if the working directory has one by this
// name.
std::string path_of(const std::string& name) {
    std::error_code error;
    const bool plain = !name.empty() && name.find('/') == std::string::npos &&
                       name.find('\0') == std::string::npos;
    if (plain && fs::is_regular_file(library() / (name + ".toml"), error) &&
        !fs::is_regular_file(name, error))
        return (library() / (name + ".toml")).string();
    if (!plain || fs::path(name).extension() == ".toml" || fs::exists(name, error)) return name;
    const auto known = library_scenes();
    auto all = known;
    for (const std::string& here : toml_names(fs::path(name).parent_path() / "."))
        all.push_back(here + ".toml");
    const std::string near = fs::is_regular_file(name + ".toml", error)
                                 ? name + ".toml"
                                 : nearest(name.substr(0, 100), all);
    throw SceneFileError(
        found_text(name) + ": neither a file nor a scene of the library; " +
        (near.empty() ? "the library has " + list_of(known) : "did you mean " + quote(near) + "?"));
}
}  // namespace

std::vector<std::string> library_scenes() { return toml_names(library()); }

std::string library_text(const std::string& file) {
    const std::string path = (library() / file).string();
    try {
        return text_of_file(path, largest_scene);
    } catch (const std::exception& e) { throw SceneFileError(found_text(path) + " " + e.what()); }
}

namespace {
struct TablesNamed : Pass<TablesNamed> {
    fs::path folder{};
    std::vector<std::string> files{};
    void add(const std::string& file) {
        if (!file.empty()) files.push_back((folder / file).string());
    }
    void columns(const char*, const std::string& file, auto&&...) { add(file); }
    void file(const char*, const std::string& name) {
        if (!name.empty()) files.push_back(name);
    }
    void start_table(const TableStart& t) { add(t.file); }
    void force(const char*, const Pluck& p) { add(p.file); }
};
}  // namespace

std::vector<std::string> files_of(const Scene& scene, const std::string& file_or_library_name) {
    const std::string path = path_of(file_or_library_name);
    TablesNamed tables;
    tables.folder = fs::path(path).parent_path();
    tables.files = {path};
    fields(tables, scene);
    return tables.files;
}

Scene parse_scene(std::string_view text, const std::string& file_name,
                  const std::vector<std::string>& overrides) {
    if (text.size() > largest_scene)
        throw SceneFileError(file_name + ":1: found " + std::to_string(text.size()) +
                             " bytes, expected at most " + std::to_string(largest_scene));
    const Document document = parse_document(text, file_name, overrides);
    Scene scene;
    try {
        scene = scene_of(document);
        // --set string.1.tension=40 on a single-string scene begins another
    } catch (const SceneFileError& e) {
        const std::string why = e.what();
        if (why.starts_with("--set ") && why.find(": found nothing") != std::string::npos)
            throw SceneFileError(why + "; strings, barriers and taps are counted from 0");
        throw;
    }
    try {
        validate(scene);
    } catch (const BadScene& e) {
        throw SceneFileError(document.place(document.nearest(e.key).place) + ": " + e.what());
    }
    return scene;
}

Scene read_scene(const std::string& file_or_library_name,
                 const std::vector<std::string>& overrides) {
    const std::string path = path_of(file_or_library_name);
    std::string text;
    try {
        text = text_of_file(path, largest_scene);
    } catch (const std::exception& e) { throw SceneFileError(found_text(path) + " " + e.what()); }
    return parse_scene(text, path, overrides);
}

}  // namespace jvari
