// Scene files: TOML <-> Scene. The keys, units, ranges and defaults are in schema.hpp; README.md beside it says them for readers of scenes.
//
// Leaves out: files larger than 1 MiB, lines with more than 64 dots, tables nested deeper than 16. They are refused, not read in part.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

// "scene.toml:12: string.0.tension: found -3, expected a positive number [N]"; for an override "--set string.0.tension=-3: ..."
struct SceneFileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A file, or a scene of the library by its name ("tanpura_c3"). An override is "key.path=value", applied before reading: arrays by index
// ("string.0.barrier.0.stiffness=1e9"), the value in TOML syntax or a bare word; it sets keys, also absent ones, and removes nothing. One
// that chooses another law or shape ("string.0.damping.law=none") leaves the file's keys of the former one unread. The scene returned has
// passed validate(). Throws SceneFileError.
Scene read_scene(const std::string& file_or_library_name, const std::vector<std::string>& overrides = {});

// The same from a text; `file_name` is what messages call it, and tables are looked for beside it.
Scene parse_scene(std::string_view text, const std::string& file_name, const std::vector<std::string>& overrides = {});

// TOML that reads back as the same scene, provided its tables still lie beside the file.
std::string write_scene(const Scene&);

// 16 hexadecimal digits (FNV-1a) over write_scene and the contents of the tables.
std::string scene_hash(const Scene&);

// Names of the scenes in the library, sorted. The library is the directory $JVARI_SCENES, else that of the sources, else the installed one.
std::vector<std::string> library_scenes();

// The file of a scene of the library as text, comments and all. Throws SceneFileError.
std::string library_text(const std::string& name);

}  // namespace jvari
