// A TOML document as plain values, each with the place it came from, so that no other file sees the TOML library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace jvari {

struct Value;
struct Member;
using Array = std::vector<Value>;
using TomlTable = std::vector<Member>;
struct Moment {};  // a date or a time: TOML has them, scenes do not

struct Value {
    std::variant<bool, std::int64_t, double, std::string, Moment, Array, TomlTable> content;
    int place = 1;  // line of the file, or -1 - i for the i-th override

    const Value* find(std::string_view key) const;  // nullptr: no table, or not in it
    std::string found() const;                      // how a message names it: 3, "text", a table
};
struct Member {
    std::string key;
    Value value;
};

struct Document {
    Value root;
    std::string file;
    std::vector<std::string> overrides;  // "key.path=value"

    std::string place(int) const;                       // "scene.toml:12" or "--set string.0.tension=30"
    const Value& nearest(std::string_view path) const;  // the value at "string.0.tension", or what of the way to it exists
};

// Applies the overrides. Throws SceneFileError for text that is no TOML and for overrides that lead nowhere.
Document parse_document(std::string_view text, const std::string& file, const std::vector<std::string>& overrides);

}  // namespace jvari
