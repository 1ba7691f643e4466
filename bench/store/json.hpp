// JSON for people and programs: two spaces a level. Bytes that are no UTF-8, as a file's name may
// hold, become U+FFFD. The library's reader and writer are compiled once, in json.cpp.
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

std::string as_utf8(const std::string& bytes);  // what is none becomes U+FFFD
std::string indented(const nlohmann::ordered_json&);
std::string compact(const nlohmann::ordered_json&);  // in one line
// Throws std::exception for what is no JSON, or nested deeper than any of ours (certificates have
// six levels): who copies or writes that calls himself once per level, to the stack's end.
nlohmann::ordered_json parsed(const std::string& text);
// Text as it stands in HTML and XML.
std::string escaped(const std::string& text);

// ---- Whole numbers of JSON, looked at before they are converted: the library makes an int of
// 1e300 as C++ does, and that is undefined.

// Throws std::runtime_error where it is no whole number that an Int can hold.
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

// ---- An outcome by its name, as files hold it.

// throws std::runtime_error where there is none
Outcome outcome_named(const std::string& name);

// ---- What was computed, in a file beside all that it was computed from:
// the one format of cells, clocks, points of maps, models of trim, and certificates.

// `identity`: JSON, all that the content depends on. `content`: an object.
std::string kept_text(const std::string& identity, const nlohmann::ordered_json& content,
                      int indent = -1);

// What `read` makes of the whole object; nothing where the file is not there or not whole, or where
// `read` throws.
template <class Read>
auto read_kept(const std::filesystem::path& file, Read read)
    -> std::optional<std::invoke_result_t<Read, const nlohmann::ordered_json&>> {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
    try {
        return read(parsed(unsealed(read_whole(file))));
    } catch (const std::exception&) {  // it is computed again
        return std::nullopt;
    }
}

// The same, and nothing where the content is of another identity.
template <class Read>
auto read_kept(const std::filesystem::path& file, const std::string& identity, Read read) {
    return read_kept(file, [&](const nlohmann::ordered_json& j) {
        if (j.at("of") != parsed(identity)) throw std::runtime_error("of something else");
        return read(j);
    });
}

}  // namespace jvari::bench::store
