

#include <fmt/core.h>
#include <fmt/format.h>
#include <sndfile.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
constexpr double full = 32767;
constexpr sf_count_t longest_signal = 100'000'000;  // samples
}  // namespace

Sound sound_of(std::span<const double> signal, double rate) {
    double peak = 0;
    for (const double v : signal) {
        if (!std::isfinite(v)) return {};
        peak = std::max(peak, std::abs(v));
    }
    // Players accept only these rates [Hz].
    if (!(peak > 0) || rate != std::round(rate) || rate < 3000 || rate > 768000) return {};
    Sound s{rate, peak, {}};
    for (const double v : signal)
        s.samples.push_back(static_cast<std::int16_t>(std::lround(v / peak * full)));
    return s;
}

std::string wav_of(const Sound& s) {
    std::string wav;
    const auto put = [&wav](auto value, int bytes) {  // little-endian
        for (int k = 0; k < bytes; ++k)
            wav += static_cast<char>(static_cast<std::uint32_t>(value) >> 8 * k);
    };
    const auto rate = static_cast<std::uint32_t>(s.rate);
    const std::size_t size = 2 * s.samples.size();
    wav += "RIFF", put(36 + size, 4), wav += "WAVEfmt ", put(16, 4);
    // PCM, one channel, bytes a second, of a frame, bits
    put(1, 2), put(1, 2), put(rate, 4), put(2 * rate, 4), put(2, 2), put(16, 2);
    wav += "data", put(size, 4);
    for (const std::int16_t v : s.samples) put(v, 2);
    return wav;
}

Signal read_signal(const fs::path& path,
                   const std::function<void(const std::string& why)>& refuse) {
    struct Close {
        void operator()(SNDFILE* f) const { sf_close(f); }
    };
    std::error_code error;  // opening a pipe would block
    if (fs::exists(path, error) && !fs::is_regular_file(path, error)) refuse("which is no file");
    SF_INFO info{};
    const std::unique_ptr<SNDFILE, Close> file(sf_open(path.c_str(), SFM_READ, &info));
    if (!file) refuse(fmt::format("which cannot be read: {}", sf_strerror(nullptr)));
    if (info.channels != 1) refuse(fmt::format("which has {} channels", info.channels));
    if (info.frames > longest_signal) refuse("which is too long");
    Signal signal{static_cast<double>(info.samplerate),
                  std::vector<double>(static_cast<std::size_t>(info.frames))};
    if (sf_readf_double(file.get(), signal.samples.data(), info.frames) != info.frames)
        refuse("which ends before its time");
    return signal;
}

Signal read_signal(const fs::path& path) {
    return read_signal(path, [&path](const std::string& why) {
        throw UsageError(
            fmt::format("{}: found a sound {}; expected one of one channel", path.string(), why));
    });
}

Sound read_wav(const fs::path& path, double peak) {
    const Signal signal = read_signal(path);
    Sound s{signal.rate, peak, {}};
    constexpr double whole = 32768;  // libsndfile's full scale
    for (const double v : signal.samples)
        s.samples.push_back(
            static_cast<std::int16_t>(std::lround(std::clamp(v * whole, -whole, full))));
    return s;
}

void write_sounds(const fs::path& folder, const std::vector<std::string>& who,
                  const std::vector<NamedSound>& sounds) {
    make_folder(folder / "sounds");
    Table t{who, {}};
    t.columns.insert(t.columns.end(),
                     {"tap", "quantity", "sample_rate", "peak", "file", "reference_file"});
    for (const NamedSound& s : sounds) {
        write_fresh(folder / "sounds" / (s.file + ".wav"), wav_of(*s.sound));
        auto& row = t.rows.emplace_back(s.who);
        row.insert(row.end(),
                   {s.tap, s.quantity, s.sound->rate, s.sound->peak, "sounds/" + s.file + ".wav",
                    s.reference.empty() ? "" : "sounds/" + s.reference + ".wav"});
    }
    write_fresh(folder / "sounds.csv", csv(t));
}

namespace {
void write_csv(const std::filesystem::path& path, const Trace& trace) {
    std::ofstream stream(path, std::ios::binary);
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "time_s");
    for (const std::string& name : trace.names) fmt::format_to(out, ",{}", quoted(name));
    for (const char* name : energy_names)
        if (!trace.energy.empty()) fmt::format_to(out, ",{}", name);
    text.push_back('\n');
    for (long n = 0; n < trace.rows; ++n) {
        fmt::format_to(out, "{:.17g}", n / trace.tap_rate);
        for (int k = 0; k < trace.taps(); ++k) fmt::format_to(out, ",{:.17g}", trace.column(k)[n]);
        if (!trace.energy.empty())
            for (int k = 0; k < 3; ++k) fmt::format_to(out, ",{:.17g}", trace.energy_column(k)[n]);
        text.push_back('\n');
        if (text.size() > 1 << 16) {
            stream.write(text.data(), static_cast<std::streamsize>(text.size()));
            text.clear();
        }
    }
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    if (!stream) throw std::runtime_error(std::strerror(errno));
}
}  // namespace

void check_trace_file(const std::filesystem::path& path) {
    if (path.extension() != ".csv")
        throw UsageError(fmt::format("--out {}: found the extension \"{}\", expected .csv or .wav",
                                     path.string(), path.extension().string()));
    must_be_writable(path);
}

void write_trace(const std::filesystem::path& path, const Trace& trace) {
    FreshFile fresh(path);
    try {
        write_csv(fresh.path(), trace);
    } catch (const std::runtime_error& why) {
        throw Unwritable(fmt::format("cannot write {}: {}", path.string(), why.what()));
    }
    fresh.keep();
}

}  // namespace jvari::bench::store
