// Whole numbers of JSON, looked at before they are converted: the library makes an int of 1e300 as C++ does, and that is undefined.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace jvari::bench::store {

// Throws std::runtime_error where it is no whole number that an Int can hold.
template <class Int>
Int whole(const nlohmann::ordered_json& j) {
    constexpr auto least = std::numeric_limits<Int>::min(), most = std::numeric_limits<Int>::max();
    if (j.is_number_unsigned()) {
        if (const auto n = j.get<std::uint64_t>(); n <= static_cast<std::uint64_t>(most)) return static_cast<Int>(n);
    } else if (j.is_number_integer()) {
        if (const auto n = j.get<std::int64_t>(); n >= least && n <= most) return static_cast<Int>(n);
    }
    throw std::runtime_error("found no whole number where one was expected");
}

}  // namespace jvari::bench::store
