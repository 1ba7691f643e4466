// What a result is addressed by, and how a file that is read back is known to be as it was written:
// XXH3-128 (Y. Collet, xxhash.com).
//
// It finds what broke, was cut off or was edited. It is no defence against a forger.
#pragma once

#include <filesystem>
#include <string>

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

}  // namespace jvari::bench::store
