#include "bench/store/sound.hpp"

#include <fmt/core.h>
#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
constexpr double full = 32767;

struct Shape {
    double mean = 0, rms = 0, peak = 0;  // of full scale 1, the mean aside
};
Shape shape_of(std::span<const std::int16_t> samples) {
    Shape s;
    if (samples.empty()) return s;
    s.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / full / static_cast<double>(samples.size());
    double squares = 0;
    for (const double v : samples) {
        squares += (v / full - s.mean) * (v / full - s.mean);
        s.peak = std::max(s.peak, std::abs(v / full - s.mean));
    }
    s.rms = std::sqrt(squares / static_cast<double>(samples.size()));
    return s;
}
}  // namespace

Sound sound_of(std::span<const double> signal, double rate) {
    double peak = 0;
    for (const double v : signal) {
        if (!std::isfinite(v)) return {};
        peak = std::max(peak, std::abs(v));
    }
    if (!(peak > 0) || rate != std::round(rate) || rate < 3000 || rate > 768000) return {};  // what players take
    Sound s{rate, peak, {}};
    for (const double v : signal) s.samples.push_back(static_cast<std::int16_t>(std::lround(v / peak * full)));
    return s;
}

std::string wav_of(const Sound& s) {
    std::string wav;
    const auto put = [&wav](auto value, int bytes) {  // little-endian
        for (int k = 0; k < bytes; ++k) wav += static_cast<char>(static_cast<std::uint32_t>(value) >> 8 * k);
    };
    const auto rate = static_cast<std::uint32_t>(s.rate);
    const std::size_t size = 2 * s.samples.size();
    wav += "RIFF", put(36 + size, 4), wav += "WAVEfmt ", put(16, 4);
    put(1, 2), put(1, 2), put(rate, 4), put(2 * rate, 4), put(2, 2), put(16, 2);  // PCM, one channel, bytes a second, of a frame, bits
    wav += "data", put(size, 4);
    for (const std::int16_t v : s.samples) put(v, 2);
    return wav;
}

Sound read_wav(const fs::path& path, double peak) {
    SF_INFO info{};
    SNDFILE* file = sf_open(path.c_str(), SFM_READ, &info);
    if (!file) throw UsageError(fmt::format("cannot read {}: {}", path.string(), sf_strerror(nullptr)));
    Sound s{static_cast<double>(info.samplerate), peak, {}};
    if (info.channels == 1 && info.frames < 100'000'000) s.samples.resize(static_cast<std::size_t>(info.frames));
    const bool good = sf_read_short(file, s.samples.data(), static_cast<sf_count_t>(s.samples.size())) == info.frames;
    sf_close(file);
    if (!good) throw UsageError(fmt::format("cannot read {}: not one channel of whole samples", path.string()));
    return s;
}

double loudest_level(const Sound& s) {
    const Shape shape = shape_of(s.samples);
    return shape.peak > 0 ? 0.9 * shape.rms / shape.peak : HUGE_VAL;
}

Sound levelled(const Sound& s, double level, double longest) {
    const Shape shape = shape_of(s.samples);
    Sound heard{s.rate, s.peak, {}};
    const auto count = std::min(s.samples.size(), static_cast<std::size_t>(longest * s.rate));
    const double gain = shape.rms > 0 ? level / shape.rms : 0, fade = 0.005 * s.rate;
    for (std::size_t n = 0; n < count; ++n) {
        const double ends = std::min({1.0, static_cast<double>(n) / fade, static_cast<double>(count - 1 - n) / fade});
        const double v = gain * ends * (s.samples[n] / full - shape.mean);
        heard.samples.push_back(static_cast<std::int16_t>(std::lround(std::clamp(v, -1.0, 1.0) * full)));
    }
    return heard;
}

void write_sounds(const fs::path& folder, const std::vector<std::string>& who, const std::vector<NamedSound>& sounds) {
    std::error_code error;
    fs::create_directories(folder / "sounds", error);
    if (error) throw UsageError(fmt::format("cannot make the folder {}: {}", (folder / "sounds").string(), error.message()));
    Table t{who, {}};
    t.columns.insert(t.columns.end(), {"tap", "quantity", "sample_rate", "peak", "file", "reference_file"});
    for (const NamedSound& s : sounds) {
        write_fresh(folder / "sounds" / (s.file + ".wav"), wav_of(*s.sound));
        auto& row = t.rows.emplace_back(s.who);
        row.insert(row.end(), {s.tap, s.quantity, text_of(s.sound->rate), text_of(s.sound->peak), "sounds/" + s.file + ".wav",
                               s.reference.empty() ? "" : "sounds/" + s.reference + ".wav"});
    }
    write_fresh(folder / "sounds.csv", csv(t));
}

}  // namespace jvari::bench::store
