// Content as text: a checksum, and base64 at the end.
//
// The checksum, XXH3-128 (Y. Collet, xxhash.com), is the address of a result, and shows that a file
// is read back as it was written. It finds what broke, was cut off or was edited. It is no defence
// against a forger.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace jvari::bench::store {

std::string hash_of(const std::string&);  // 32 hexadecimal digits

// Of the first 256 MB of a file; of a longer one its size and time count as well. "cannot be read"
// where it cannot.
std::string hash_of_file(const std::filesystem::path&);

// The text of a JSON object with the checksum of all that stands before it as its last member.
std::string sealed(const std::string& object);
// That object without its checksum. Throws std::runtime_error where the checksum is not that of the
// content.
std::string unsealed(const std::string& file);

// A word as a shell reads it back: in apostrophes where it is not plain.
std::string shell_word(const std::string&);

// ---- Base64 (RFC 4648, section 4): bytes as text, in a record and in a page.

std::string base64(std::string_view bytes);
// least significant byte first, as in a .wav
std::string base64(std::span<const std::int16_t> samples);
// throws std::runtime_error where the text is none
std::string bytes_of_base64(std::string_view text);
std::vector<std::int16_t> samples_of_base64(std::string_view text);

}  // namespace jvari::bench::store
