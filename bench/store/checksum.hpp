// What a result is addressed by, and how a file that is read back is known to be as it was written: XXH3-128 (Y. Collet, xxhash.com).
//
// It finds what broke, was cut off or was edited. It is no defence against a forger.
#pragma once

#include <string>

namespace jvari::bench::store {

std::string hash_of(const std::string&);  // 32 hexadecimal digits

// The text of a JSON object with the checksum of all that stands before it as its last member.
std::string sealed(const std::string& object);
// That object without its checksum. Throws std::runtime_error where the checksum is not that of the content.
std::string unsealed(const std::string& file);

}  // namespace jvari::bench::store
