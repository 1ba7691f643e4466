

#include <fmt/core.h>
#include <array>
#include <cstdint>
#include <stdexcept>

#include "bench/store/encoding.hpp"

#define XXH_INLINE_ALL  // header only: there is nothing to link
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

std::string shell_word(const std::string& word) {
    constexpr const char* plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

namespace {
constexpr char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
}

std::string base64(std::string_view bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three =
                three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : alphabet[three >> (18 - 6 * k) & 63];
    }
    return text;
}

std::string base64(std::span<const std::int16_t> samples) {
    std::string bytes;
    for (const std::int16_t v : samples) {
        bytes += static_cast<char>(v & 255);
        bytes += static_cast<char>(v >> 8 & 255);
    }
    return base64(std::string_view(bytes));
}

std::string bytes_of_base64(std::string_view text) {
    std::array<int, 256> value;
    value.fill(-1);
    for (int k = 0; k < 64; ++k) value[static_cast<unsigned char>(alphabet[k])] = k;
    std::string bytes;
    if (text.size() % 4 != 0) throw std::runtime_error("no base64: its length is no multiple of 4");
    for (std::size_t i = 0; i < text.size(); i += 4) {
        const bool last = i + 4 == text.size();
        const std::size_t letters = last && text[i + 3] == '=' ? (text[i + 2] == '=' ? 2 : 3) : 4;
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const int v = k < letters ? value[static_cast<unsigned char>(text[i + k])] : 0;
            if (v < 0) throw std::runtime_error("no base64: it holds other letters");
            three = three << 6 | static_cast<std::uint32_t>(v);
        }
        for (std::size_t k = 0; k + 1 < letters; ++k)
            bytes += static_cast<char>(three >> (16 - 8 * k) & 255);
    }
    return bytes;
}

std::vector<std::int16_t> samples_of_base64(std::string_view text) {
    const std::string bytes = bytes_of_base64(text);
    std::vector<std::int16_t> samples;
    for (std::size_t n = 0; n + 1 < bytes.size(); n += 2)
        samples.push_back(static_cast<std::int16_t>(static_cast<unsigned char>(bytes[n]) |
                                                    static_cast<unsigned char>(bytes[n + 1]) << 8));
    return samples;
}

}  // namespace jvari::bench::store
