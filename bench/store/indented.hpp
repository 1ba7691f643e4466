// JSON for people and programs: two spaces a level. Bytes that are no UTF-8, as a file's name may hold, become U+FFFD.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace jvari::bench::store {

inline std::string indented(const nlohmann::ordered_json& j) {
    return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace jvari::bench::store
