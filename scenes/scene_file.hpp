// Reads and writes scene files (TOML). schema.hpp has the keys, units, ranges and defaults,
// README.md explains them.
//
// Files larger than 1 MiB, keys of more than 64 parts and tables nested deeper than 16 are refused.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

// "scene.toml:12: string.0.tension: found -3, expected a positive number [N]"; for an override
// "--set string.0.tension=-3: ..."
struct SceneFileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Reads a file, or a library scene by its name ("tanpura_c3"), and validates it. An override is
// "key.path=value", with the value in TOML syntax or a bare word
// ("string.0.barrier.0.stiffness=1e9"). It sets a key or adds it. If it chooses another law or
// shape ("string.0.damping.law=none"), the file's keys for the former one are not read. Throws
// SceneFileError.
Scene read_scene(const std::string& file_or_library_name,
                 const std::vector<std::string>& overrides = {});

// Reads the same from a text. Messages call it `file_name`, and tables are looked for beside that
// file.
Scene parse_scene(std::string_view text, const std::string& file_name,
                  const std::vector<std::string>& overrides = {});

// Lists the scene file and its tables' files.
std::vector<std::string> files_of(const Scene&, const std::string& file_or_library_name);

// Writes TOML that reads back into an equal scene, if its tables lie beside the file.
std::string write_scene(const Scene&);

// 16 hexadecimal digits: FNV-1a over write_scene() and the tables' contents.
std::string scene_hash(const Scene&);

// Sorted names of the library's scenes. The library is $JVARI_SCENES, or else the source folder, or
// else the installed folder.
std::vector<std::string> library_scenes();

// Text of a library file, with its comments. Throws SceneFileError.
std::string library_text(const std::string& file);

}  // namespace jvari
