// What was computed, in a file beside all that it was computed from: the one format of cells, clocks, points of maps and models of trim.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"

namespace jvari::bench::store {

// `identity`: JSON, all that the content depends on. `content`: an object.
inline std::string kept_text(const std::string& identity, const nlohmann::ordered_json& content) {
    using Json = nlohmann::ordered_json;
    Json j{{"of", Json::parse(identity)}};
    j.update(content);
    return sealed(j.dump(-1, ' ', false, Json::error_handler_t::replace));
}

// What `read` makes of the whole object; nothing where the file is not there or not whole, or where `read` throws.
template <class Read>
auto read_kept(const std::filesystem::path& file, Read read) -> std::optional<std::invoke_result_t<Read, const nlohmann::ordered_json&>> {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
    try {
        return read(nlohmann::ordered_json::parse(unsealed(read_whole(file))));
    } catch (const std::exception&) {  // it is computed again
        return std::nullopt;
    }
}

// The same, and nothing where the content is of another identity.
template <class Read>
auto read_kept(const std::filesystem::path& file, const std::string& identity, Read read) {
    return read_kept(file, [&](const nlohmann::ordered_json& j) {
        if (j.at("of") != nlohmann::ordered_json::parse(identity)) throw std::runtime_error("of something else");
        return read(j);
    });
}

}  // namespace jvari::bench::store
