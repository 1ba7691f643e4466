// JSON for people and programs: two spaces a level. Bytes that are no UTF-8, as a file's name may
// hold, become U+FFFD.
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

inline std::string as_utf8(const std::string& bytes) {  // what is none becomes U+FFFD
    using Json = nlohmann::json;
    return Json::parse(Json(bytes).dump(-1, ' ', false, Json::error_handler_t::replace));
}

inline std::string indented(const nlohmann::ordered_json& j) {
    return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

// Throws std::exception for what is no JSON, or nested deeper than any of ours (certificates have
// six levels): who copies or writes that calls himself once per level, to the stack's end.
inline nlohmann::ordered_json parsed(const std::string& text) {
    using Json = nlohmann::ordered_json;
    constexpr int deepest = 32;
    return Json::parse(text, [](int level, Json::parse_event_t event, const Json&) {
        if (level >= deepest && (event == Json::parse_event_t::object_start ||
                                 event == Json::parse_event_t::array_start))
            throw std::runtime_error("it is nested deeper than 32 levels");
        return true;
    });
}

// Text as it stands in HTML and XML.
inline std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text)
        safe += c == '&'                               ? "&amp;"
                : c == '<'                             ? "&lt;"
                : c == '>'                             ? "&gt;"
                : c == '"'                             ? "&quot;"
                : static_cast<unsigned char>(c) < 0x20 ? " "
                                                       : std::string(1, c);
    return safe;
}

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
inline Outcome outcome_named(const std::string& name) {
    for (const Outcome o : {Outcome::ok, Outcome::diverged, Outcome::not_converged})
        if (name == name_of(o)) return o;
    throw std::runtime_error("unknown status " + name);
}

// ---- What was computed, in a file beside all that it was computed from:
// the one format of cells, clocks, points of maps, models of trim, and certificates.

// `identity`: JSON, all that the content depends on. `content`: an object.
inline std::string kept_text(const std::string& identity, const nlohmann::ordered_json& content,
                             int indent = -1) {
    using Json = nlohmann::ordered_json;
    Json j{{"of", Json::parse(identity)}};
    j.update(content);
    return sealed(j.dump(indent, ' ', false, Json::error_handler_t::replace));
}

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
        if (j.at("of") != nlohmann::ordered_json::parse(identity))
            throw std::runtime_error("of something else");
        return read(j);
    });
}

}  // namespace jvari::bench::store
