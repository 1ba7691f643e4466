#include "bench/store/sound.hpp"

#include <fmt/core.h>
#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
constexpr double full = 32767;

struct Memory {  // a file that libsndfile writes into
    std::string bytes;
    sf_count_t at = 0;
};

SF_VIRTUAL_IO memory_calls() {
    SF_VIRTUAL_IO io{};
    io.get_filelen = [](void* m) { return static_cast<sf_count_t>(static_cast<Memory*>(m)->bytes.size()); };
    io.seek = [](sf_count_t offset, int whence, void* user) {
        auto* m = static_cast<Memory*>(user);
        m->at = offset + (whence == SEEK_SET ? 0 : whence == SEEK_CUR ? m->at : static_cast<sf_count_t>(m->bytes.size()));
        return m->at;
    };
    io.read = [](void* to, sf_count_t count, void* user) {
        auto* m = static_cast<Memory*>(user);
        count = std::clamp<sf_count_t>(static_cast<sf_count_t>(m->bytes.size()) - m->at, 0, count);
        std::memcpy(to, m->bytes.data() + m->at, static_cast<std::size_t>(count));
        m->at += count;
        return count;
    };
    io.write = [](const void* from, sf_count_t count, void* user) {
        auto* m = static_cast<Memory*>(user);
        m->bytes.resize(std::max(m->bytes.size(), static_cast<std::size_t>(m->at + count)));
        std::memcpy(m->bytes.data() + m->at, from, static_cast<std::size_t>(count));
        m->at += count;
        return count;
    };
    io.tell = [](void* m) { return static_cast<Memory*>(m)->at; };
    return io;
}

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
    SF_INFO info{};
    info.samplerate = static_cast<int>(s.rate);
    info.channels = 1;
    info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
    Memory memory;
    SF_VIRTUAL_IO calls = memory_calls();
    SNDFILE* file = sf_open_virtual(&calls, SFM_WRITE, &info, &memory);
    if (!file) throw std::runtime_error(std::string("no sound: ") + sf_strerror(nullptr));
    const auto count = static_cast<sf_count_t>(s.samples.size());
    const bool good = sf_write_short(file, s.samples.data(), count) == count;
    if (sf_close(file) != 0 || !good) throw std::runtime_error("a sound could not be written");
    return std::move(memory.bytes);
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
