// A TOML document in plain values, each with its place in the file. No other file includes the TOML
// library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace jvari {

struct Value;
struct Member;
using Array = std::vector<Value>;
using TomlTable = std::vector<Member>;
struct Moment {};  // a date or a time, which scenes do not use

struct Value {
    std::variant<bool, std::int64_t, double, std::string, Moment, Array, TomlTable> content;
    int place = 1;  // line of the file; -1 - i for the i-th override

    // nullptr if this is no table or has no such key
    const Value* find(std::string_view key) const;
    std::optional<std::int64_t> whole() const;  // accepts 1000 and 1e3
    std::string found() const;                  // for messages: 3, "text", a table
};
struct Member {
    std::string key;
    Value value;
};

struct Document {
    Value root;
    std::string file;
    std::vector<std::string> overrides;  // "key.path=value"

    // "scene.toml:12" or "--set string.0.tension=30"
    std::string place(int) const;
    // the value at "string.0.tension", or its nearest existing parent
    const Value& nearest(std::string_view path) const;
};

// Parses the text and applies the overrides. Throws SceneFileError for invalid TOML and for
// overrides of keys that cannot exist.
Document parse_document(std::string_view text, const std::string& file,
                        const std::vector<std::string>& overrides);

// Turns the document into a scene; validate() checks rules that involve several values. Throws
// SceneFileError. (scene_reader.cpp)
struct Scene;
Scene scene_of(const Document&);

}  // namespace jvari
