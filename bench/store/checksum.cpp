#include "bench/store/checksum.hpp"

#include <fmt/core.h>

#define XXH_INLINE_ALL  // the header alone: nothing to link
#include <xxhash.h>

#include <fstream>
#include <stdexcept>
#include <string_view>

namespace jvari::bench::store {

namespace {
constexpr std::size_t digits = 32;
constexpr std::string_view before = ",\n \"checksum\": \"", after = "\"\n}\n";
}  // namespace

std::string hash_of(const std::string& text) {
    const XXH128_hash_t h = XXH3_128bits(text.data(), text.size());
    return fmt::format("{:016x}{:016x}", h.high64, h.low64);
}

std::string hash_of_file(const std::filesystem::path& path) {
    constexpr int most_parts = 256;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) return "cannot be read";
    std::string hash, part(1 << 20, '\0');
    for (int k = 0;
         k < most_parts &&
         stream.read(part.data(), static_cast<std::streamsize>(part.size())).gcount() > 0;
         ++k)
        hash = hash_of(hash + part.substr(0, static_cast<std::size_t>(stream.gcount())));
    std::error_code error;
    if (stream.peek() != std::ifstream::traits_type::eof())
        hash +=
            fmt::format(" {} {}", std::filesystem::file_size(path, error),
                        std::filesystem::last_write_time(path, error).time_since_epoch().count());
    return hash;
}

std::string sealed(const std::string& object) {
    std::string content = object.substr(0, object.rfind('}'));
    content.resize(content.find_last_not_of(" \n") + 1);
    return content + std::string(before) + hash_of(content) + std::string(after);
}

std::string unsealed(const std::string& file) {
    constexpr std::size_t seal = before.size() + digits + after.size();
    const std::size_t end = file.size() < seal ? 0 : file.size() - seal;
    std::string content = file.substr(0, end);
    if (file.substr(end) != std::string(before) + hash_of(content) + std::string(after))
        throw std::runtime_error("its checksum is not that of its content");
    content += "\n}";
    return content;
}

}  // namespace jvari::bench::store
