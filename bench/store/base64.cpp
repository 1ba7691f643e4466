#include "bench/store/base64.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>

namespace jvari::bench::store {

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
