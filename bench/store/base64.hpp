// Base64 (RFC 4648, section 4): bytes as text, in a record and in a page.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace jvari::bench::store {

std::string base64(std::string_view bytes);
// least significant byte first, as in a .wav
std::string base64(std::span<const std::int16_t> samples);
// throws std::runtime_error where the text is none
std::string bytes_of_base64(std::string_view text);
std::vector<std::int16_t> samples_of_base64(std::string_view text);

}  // namespace jvari::bench::store
