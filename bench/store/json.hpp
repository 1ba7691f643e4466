// JSON for people and programs: two spaces a level. Bytes that are not UTF-8, which a file's name
// may contain, become U+FFFD. The library's reader and writer are compiled once, in json.cpp.
#pragma once

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::store {

std::string as_utf8(const std::string& bytes);  // invalid bytes become U+FFFD
std::string indented(const nlohmann::ordered_json&);
std::string compact(const nlohmann::ordered_json&);  // on one line
// Throws std::exception for text that is not JSON, or is nested deeper than any JSON we write
// (certificates have six levels). Copying or writing JSON recurses once per level, and deep nesting
// would exhaust the stack.
nlohmann::ordered_json parsed(const std::string& text);
// Escapes text for HTML and XML.
std::string escaped(const std::string& text);

// ---- Whole numbers of JSON are checked before they are converted: the library converts 1e300 to
// an int as C++ does, with undefined behaviour.

// Throws std::runtime_error unless the value is a whole number that fits an Int.
template <class Int>
Int whole(const nlohmann::ordered_json& j) {
    constexpr auto least = std::numeric_limits<Int>::min(), most = std::numeric_limits<Int>::max();
    if (j.is_number_unsigned()) {
        if (const auto n = j.get<std::uint64_t>(); n <= static_cast<std::uint64_t>(most))
            return static_cast<Int>(n);
    } else if (j.is_number_integer()) {
        if (const auto n = j.get<std::int64_t>(); n >= least && n <= most)
            return static_cast<Int>(n);
    }
    throw std::runtime_error("found no whole number where one was expected");
}

// ---- Outcomes by name, as files store them.

// Throws std::runtime_error for an unknown name.
Outcome outcome_named(const std::string& name);

// ---- Results in files, each beside everything that it was computed from. Cells, timings, points
// of maps, models of trim, and certificates share this one format.

// `identity`: JSON, everything that the content depends on. `content`: an object.
std::string kept_text(const std::string& identity, const nlohmann::ordered_json& content,
                      int indent = -1);

// Reads the whole object through `read` and returns the result. Returns nothing if the file is
// missing or damaged, or if `read` throws.
template <class Read>
auto read_kept(const std::filesystem::path& file, Read read)
    -> std::optional<std::invoke_result_t<Read, const nlohmann::ordered_json&>> {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
    try {
        return read(parsed(unsealed(read_whole(file))));
    } catch (const std::exception&) {  // the caller computes the result again
        return std::nullopt;
    }
}

// Also returns nothing if the content has another identity.
template <class Read>
auto read_kept(const std::filesystem::path& file, const std::string& identity, Read read) {
    return read_kept(file, [&](const nlohmann::ordered_json& j) {
        if (j.at("of") != parsed(identity)) throw std::runtime_error("of something else");
        return read(j);
    });
}

}  // namespace jvari::bench::store
