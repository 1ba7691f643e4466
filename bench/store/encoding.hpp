// Encodes content as text: a checksum, and base64 at the end.
//
// The checksum, XXH3-128 (Y. Collet, xxhash.com), is the address of a result, and shows whether a
// file is read back unchanged. The checksum finds damage, truncation and edits. It does not protect
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

// Hashes the first 256 MB of a file; for a longer file the hash includes its size and time of last
// change. Returns "cannot be read" if the file cannot be opened.
std::string hash_of_file(const std::filesystem::path&);

// Appends a last member to the text of a JSON object: the checksum of everything before it.
std::string sealed(const std::string& object);
// Returns the object without its checksum. Throws std::runtime_error if the checksum does not match
// the content.
std::string unsealed(const std::string& file);

// Quotes a word for a shell: apostrophes surround every word with a special character.
std::string shell_word(const std::string&);

// ---- Base64 (RFC 4648, section 4): bytes as text, in a record and in a page.

std::string base64(std::string_view bytes);
// Samples are little-endian, as in a .wav file.
std::string base64(std::span<const std::int16_t> samples);
// Throws std::runtime_error if the text is not base64.
std::string bytes_of_base64(std::string_view text);
std::vector<std::int16_t> samples_of_base64(std::string_view text);

}  // namespace jvari::bench::store
