#include "scenes/excitation_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "scenes/columns.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/schema.hpp"

namespace jvari {

namespace {
constexpr Range mode_number{"the number of a mode, a whole number >= 1", 1};

// The bytes of a RIFF WAVE file, little-endian: chunks of a name, a size and a content.
class Wav {
public:
    Wav(const std::string& path, std::string_view bytes) : path_(path) {
        if (bytes.size() < 12 || bytes.substr(0, 4) != "RIFF" || bytes.substr(8, 4) != "WAVE")
            refuse("no RIFF WAVE file");
        bytes.remove_prefix(12);
        while (bytes.size() >= 8) {
            const std::string_view name = bytes.substr(0, 4);
            const std::size_t size = number(bytes.substr(4, 4));
            bytes.remove_prefix(8);
            if (name == "fmt ") format_ = bytes.substr(0, size);
            if (name == "data") data_ = bytes.substr(0, size);
            bytes.remove_prefix(std::min(bytes.size(), size + size % 2));
        }
        if (format_.size() < 16) refuse("no format");
        tag_ = static_cast<int>(number(format_.substr(0, 2)));
        if (tag_ == extensible && format_.size() >= 26)
            tag_ = static_cast<int>(number(format_.substr(24, 2)));
        bytes_ = number(format_.substr(14, 2)) / 8;
        if (const auto channels = number(format_.substr(2, 2)); channels != 1)
            refuse(std::to_string(channels) + " channels");
        if (!(tag_ == pcm && bytes_ >= 2 && bytes_ <= 4) &&
            !(tag_ == floating && (bytes_ == 4 || bytes_ == 8)))
            refuse("samples of another kind");
    }
    double rate() const { return static_cast<double>(number(format_.substr(4, 4))); }
    std::size_t count() const { return data_.size() / bytes_; }
    double sample(std::size_t n) const {
        const std::uint64_t bits = number(data_.substr(n * bytes_, bytes_));
        if (tag_ == floating && bytes_ == 8) return std::bit_cast<double>(bits);
        if (tag_ == floating) return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        const int shift = 64 - 8 * static_cast<int>(bytes_);  // sign
        return std::ldexp(static_cast<double>(static_cast<std::int64_t>(bits << shift)), -63);
    }
    [[noreturn]] void refuse(const std::string& found) const {
        throw SceneFileError(path_ + ": found " + found +
                             ", expected a sound of one channel, of 16, 24 or 32 bit or floating "
                             "point");
    }

private:
    static constexpr int pcm = 1, floating = 3, extensible = 0xfffe;
    static std::uint64_t number(std::string_view bytes) {
        std::uint64_t n = 0;
        for (std::size_t k = bytes.size(); k-- > 0;)
            n = n << 8 | static_cast<unsigned char>(bytes[k]);
        return n;
    }
    std::string path_;
    std::string_view format_, data_;
    int tag_ = 0;
    std::size_t bytes_ = 0;
};
}  // namespace

TableStart start_from(const std::string& path, const std::string& text) {
    TableStart t;
    std::vector<double> x, mode;
    const ColumnTo columns[] = {
        {{"x_m", "x_m", any}, x, true},
        {{"mode", "mode", mode_number}, mode, true},
        {{"displacement_m", "displacement", any}, t.displacement},
        {{"velocity_m_per_s", "velocity", any}, t.velocity, true},
    };
    read_columns(path, text, columns);
    if (x.empty() == mode.empty())
        throw SceneFileError(
            path + ": found " +
            (x.empty() ? "no rows of \"x_m\" or \"mode\"" : "\"x_m\" and \"mode\"") +
            ", expected rows of one of the columns \"x_m\" and \"mode\"");
    t.of_modes = x.empty();
    t.at = t.of_modes ? mode : x;
    if (t.velocity.empty()) t.velocity.assign(t.at.size(), 0.0);
    return t;
}

void force_from(const std::string& path, const std::string& text, Pluck& p) {
    if (path.ends_with(".wav")) {
        const Wav wav(path, text);
        if (!(wav.rate() > 0)) wav.refuse("no sample rate");
        for (std::size_t n = 0; n < wav.count(); ++n) {
            p.time.push_back(static_cast<double>(n) / wav.rate());
            p.share.push_back(wav.sample(n));
            if (!std::isfinite(p.share.back())) wav.refuse("a sample that is no number");
        }
    } else {
        const ColumnTo columns[] = {{{"time_s", "time", not_negative}, p.time},
                                    {{"force_N", "newtons", any}, p.share}};
        read_columns(path, text, columns);
    }
    for (const double F : p.share) p.peak = std::max(p.peak, std::abs(F));
    if (p.time.size() < 2 || !(p.peak > 0))
        throw SceneFileError(path + ": found " + std::to_string(p.time.size()) +
                             " rows and a largest force of " + std::to_string(p.peak) +
                             " N, expected two rows at least and a force");
    for (double& F : p.share) F /= p.peak;
    p.amplitude = p.peak;
    p.start = p.time.front();
    p.duration = p.time.back() - p.start;
}

}  // namespace jvari
