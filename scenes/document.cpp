// Parses TOML with toml++; no other file includes that library.
#include "scenes/document.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"

namespace jvari {

namespace {
constexpr int deepest = 16;  // levels of nesting; scenes have five
// A key with very many parts would nest tables more deeply than the stack allows.
constexpr int dots_in_a_key = 64;

template <class Indexed>
std::optional<std::size_t> index_in(const Indexed& name) {
    std::size_t i = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), i);
    if (error != std::errc() || end != name.data() + name.size()) return {};
    return i;
}

// Position behind the TOML text that begins at `from`: "", '', """ """ or ''' '''. A text without a
// closing mark ends with its line, or with the document.
std::size_t end_of_text(std::string_view all, std::size_t from) {
    const char mark = all[from];
    const bool lines = all.substr(from, 3) == std::string(3, mark);
    for (std::size_t i = from + (lines ? 3 : 1); i < all.size(); ++i) {
        if (mark == '"' && all[i] == '\\') ++i;
        else if (lines && all.substr(i, 3) == std::string(3, mark))
            return std::min({all.find_first_not_of(mark, i), i + 5, all.size()});
        else if (!lines && (all[i] == mark || all[i] == '\n')) return all[i] == mark ? i + 1 : i;
    }
    return all.size();
}

std::vector<std::string> parts_of(std::string_view path) {
    std::vector<std::string> parts{""};
    for (const char c : path) {
        if (c == '.') parts.emplace_back();
        else parts.back() += c;
    }
    return parts;
}
}  // namespace

const Value* Value::find(std::string_view key) const {
    const auto* table = std::get_if<TomlTable>(&content);
    if (!table) return nullptr;
    const auto member =
        std::find_if(table->begin(), table->end(), [key](const Member& m) { return m.key == key; });
    return member == table->end() ? nullptr : &member->value;
}

std::string Value::found() const {
    struct Says {
        std::string operator()(bool b) const { return b ? "true" : "false"; }
        std::string operator()(std::int64_t i) const { return std::to_string(i); }
        std::string operator()(double x) const { return number_text(x); }
        std::string operator()(const std::string& s) const { return found_text(s); }
        std::string operator()(const Moment&) const { return "a date or time"; }
        std::string operator()(const Array&) const { return "an array"; }
        std::string operator()(const TomlTable&) const { return "a table"; }
    };
    return std::visit(Says{}, content);
}

std::optional<std::int64_t> Value::whole() const {
    if (const auto* n = std::get_if<std::int64_t>(&content)) return *n;
    const auto* x = std::get_if<double>(&content);
    return x && std::abs(*x) < 1e15 && *x == std::floor(*x)
               ? std::optional(static_cast<std::int64_t>(*x))
               : std::nullopt;
}

std::string Document::place(int p) const {
    if (p < 0) return "--set " + overrides[static_cast<std::size_t>(-1 - p)];
    return file + ":" + std::to_string(p);
}

const Value& Document::nearest(std::string_view path) const {
    const Value* at = &root;
    for (const std::string& part : parts_of(path)) {
        const Value* next = at->find(part);
        if (const auto* array = std::get_if<Array>(&at->content)) {
            const auto i = index_in(part);
            next = i && *i < array->size() ? &(*array)[*i] : nullptr;
        }
        if (!next) break;
        at = next;
    }
    return *at;
}

namespace {
struct Reading {
    const std::string& where;  // "scene.toml" or "--set ..."
    int place;                 // 0: take the line from the document
    std::string at(int line) const { return place ? where : where + ":" + std::to_string(line); }

    // Between two of , = [ ] { } and line ends there is at most one key. Dots in texts and comments
    // do not count.
    void refuse_long_keys(std::string_view text) const {
        int line = 1, dots = 0;
        for (std::size_t i = 0; i < text.size(); ++i) {
            const char c = text[i];
            if (c == '"' || c == '\'') {
                const std::size_t end = end_of_text(text, i);
                line += static_cast<int>(std::count(text.begin() + static_cast<long>(i),
                                                    text.begin() + static_cast<long>(end), '\n'));
                i = end - 1;
            } else if (c == '#') {
                i = std::min(text.find('\n', i), text.size()) - 1;
            } else if (c == '.') {
                if (++dots > dots_in_a_key)
                    throw SceneFileError(at(line) + ": found a key with more than " +
                                         std::to_string(dots_in_a_key) + " dots, expected fewer");
            } else if (std::string_view(",=[]{}\n").find(c) != std::string_view::npos) {
                dots = 0;
                line += c == '\n';
            }
        }
    }

    Value value(const toml::node& node, int level) const {
        const int line = static_cast<int>(node.source().begin.line);
        if (level > deepest)
            throw SceneFileError(at(line) + ": found tables or arrays nested deeper than " +
                                 std::to_string(deepest));
        Value v;
        v.place = place ? place : line > 0 ? line : 1;
        if (const auto* table = node.as_table()) {
            std::multimap<std::pair<int, unsigned>, Member> in_file;  // by line and column
            for (const auto& [key, child] : *table) {
                Member m{std::string(key.str()), value(child, level + 1)};
                in_file.emplace(std::pair{m.value.place, child.source().begin.column}, m);
            }
            TomlTable members;
            for (auto& [at, member] : in_file) members.push_back(std::move(member));
            if (!place && line == 0 && !members.empty()) v.place = members.front().value.place;
            v.content = std::move(members);
        } else if (const auto* array = node.as_array()) {
            Array items;
            for (const toml::node& child : *array) items.push_back(value(child, level + 1));
            v.content = std::move(items);
        } else if (const auto text = node.value_exact<std::string>()) {
            v.content = *text;
        } else if (const auto integer = node.value_exact<std::int64_t>()) {
            v.content = *integer;
        } else if (const auto number = node.value_exact<double>()) {
            v.content = *number;
        } else if (const auto truth = node.value_exact<bool>()) {
            v.content = *truth;
        } else {
            v.content = Moment{};
        }
        return v;
    }

    Value parse(std::string_view text) const {
        refuse_long_keys(text);
        try {
            const toml::table table = toml::parse(text);
            return value(table, 0);
        } catch (const toml::parse_error& e) {
            throw SceneFileError(at(static_cast<int>(e.source().begin.line)) +
                                 ": not valid TOML: " + std::string(e.description()));
        }
    }
};

// Reads a bare number by number_of, and any other value by TOML syntax. Text that is not a TOML
// value, or a number in another form (0x10), is taken literally.
Value override_value(std::string_view text, const Reading& reading) {
    const auto one = [&](std::string_view value) {
        Value root = reading.parse("value = " + std::string(value));
        auto& table = std::get<TomlTable>(root.content);
        if (table.size() != 1)
            throw SceneFileError(reading.at(0) + ": found a line break in the value");
        return std::move(table.front().value);
    };
    const bool bare =
        text.empty() || std::string_view("\"'[{").find(text.front()) == std::string_view::npos;
    if (!bare) return one(text);
    const std::size_t from = std::min(text.find_first_not_of(' '), text.size());
    if (const auto x = number_of(text.substr(from, text.find_last_not_of(' ') + 1 - from))) {
        const bool digits = text.find_first_not_of("+-0123456789 ") == std::string_view::npos;
        if (const auto n = Value{*x}.whole(); n && digits) return {*n, reading.place};
        return {*x, reading.place};
    }
    try {
        Value v = one(text);
        const bool number = std::holds_alternative<std::int64_t>(v.content) ||
                            std::holds_alternative<double>(v.content);
        return number ? one(quote(text)) : v;
    } catch (const SceneFileError&) { return one(quote(text)); }
}

bool is_index(std::string_view s) {
    return !s.empty() && s.find_first_not_of("0123456789") == std::string_view::npos;
}

// Returns the value at the path and creates it if absent: a table by its key, an entry of an array
// by its index or by the index after the last.
Value& reach(Value& root, const std::vector<std::string>& path, const std::string& where,
             int place) {
    Value* at = &root;
    std::string walked;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const std::string& part = path[i];
        const auto refuse = [&](const std::string& found, const std::string& expected) {
            throw SceneFileError(where + ": " + (walked.empty() ? part : walked) + ": found " +
                                 found + ", expected " + expected);
        };
        if (auto* array = std::get_if<Array>(&at->content)) {
            const auto index = is_index(part) ? index_in(part) : std::nullopt;
            if (!index || *index > array->size())
                refuse(is_index(part) ? "index " + part : found_text(part),
                       is_index(part) || part.empty()
                           ? "an index from 0 to " + std::to_string(array->size())
                           : "an index, as in " + walked + ".0." + part);
            if (*index == array->size()) array->push_back({TomlTable{}, place});
            at = &(*array)[*index];
        } else if (auto* table = std::get_if<TomlTable>(&at->content)) {
            if (part.empty())
                throw SceneFileError(where +
                                     ": found an empty part in the key, expected key.path=value");
            const auto member = std::find_if(table->begin(), table->end(),
                                             [&](const Member& m) { return m.key == part; });
            if (member == table->end()) {
                const bool array_follows = i + 1 < path.size() && is_index(path[i + 1]);
                table->push_back(
                    {part, array_follows ? Value{Array{}, place} : Value{TomlTable{}, place}});
                at = &table->back().value;
            } else {
                at = &member->value;
            }
        } else {
            refuse(at->found(), "a table with the key " + found_text(part));
        }
        walked += (walked.empty() ? "" : ".") + part;
    }
    return *at;
}

// Old scenes call `start` `initial`. If a string has both keys, both stay, and the reader refuses
// them.
void rename_initial(Value& root) {
    for (Member& part : std::get<TomlTable>(root.content)) {
        auto* strings = std::get_if<Array>(&part.value.content);
        if (part.key != "string" || !strings) continue;
        for (Value& s : *strings)
            if (auto* keys = std::get_if<TomlTable>(&s.content); keys && !s.find("start"))
                for (Member& m : *keys)
                    if (m.key == "initial") m.key = "start";
    }
}
}  // namespace

Document parse_document(std::string_view text, const std::string& file,
                        const std::vector<std::string>& overrides) {
    Document d{Reading{file, 0}.parse(text), file, overrides};
    d.root.place = 1;
    rename_initial(d.root);
    for (std::size_t i = 0; i < overrides.size(); ++i) {
        const int place = -1 - static_cast<int>(i);
        const std::string where = d.place(place);
        const std::size_t equals = overrides[i].find('=');
        const std::string key = overrides[i].substr(0, equals);
        auto path = parts_of(key.substr(0, key.find_last_not_of(' ') + 1));
        if (equals == std::string::npos || equals == 0)
            throw SceneFileError(where + ": expected key.path=value");
        if (path.size() > deepest)
            throw SceneFileError(where + ": found a key of " + std::to_string(path.size()) +
                                 " parts, expected at most " + std::to_string(deepest));
        if (path.size() > 2 && path[0] == "string" && path[2] == "initial") path[2] = "start";
        Value value = override_value(std::string_view(overrides[i]).substr(equals + 1),
                                     Reading{where, place});
        reach(d.root, path, where, place) = std::move(value);
    }
    return d;
}

}  // namespace jvari
