#include "bench/store/trace_file.hpp"

#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/trace_hdf5.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::store {

namespace {
constexpr const char* energy_names[] = {"energy_stored_J", "energy_supplied_J", "energy_dissipated_J"};

void write_csv(const std::filesystem::path& path, const Trace& trace) {
    std::ofstream stream(path, std::ios::binary);
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    bool first = true;
    for (const std::string& name : trace_columns(trace)) {
        fmt::format_to(out, "{}{}", first ? "" : ",", quoted(name));
        first = false;
    }
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

int sndfile_format(const std::string& name) {
    if (name == "float32") return SF_FORMAT_FLOAT;
    if (name == "pcm24") return SF_FORMAT_PCM_24;
    if (name == "pcm16") return SF_FORMAT_PCM_16;
    return SF_FORMAT_DOUBLE;
}

std::string write_wav(const std::filesystem::path& path, const std::string& format, const Trace& trace) {
    const bool pcm = format.rfind("pcm", 0) == 0;
    std::vector<double> gain(trace.taps(), 1.0);
    std::string said;
    for (int k = 0; pcm && k < trace.taps(); ++k) {
        double most = 0;
        for (double v : trace.column(k)) most = std::max(most, std::abs(v));
        if (most > 0 && std::isfinite(most)) gain[k] = 1 / most;
        said += fmt::format("{}{} x {:.6g}", k ? ", " : "level-normalised: ", trace.names[k], gain[k]);
    }
    SF_INFO info{};
    info.samplerate = static_cast<int>(std::lround(trace.tap_rate));
    info.channels = trace.taps();
    info.format = SF_FORMAT_WAV | sndfile_format(format);
    SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
    if (!file) throw std::runtime_error(sf_strerror(nullptr));
    sf_command(file, SFC_SET_CLIPPING, nullptr, SF_TRUE);
    std::vector<double> frame(trace.taps());
    bool good = true;
    for (long n = 0; n < trace.rows && good; ++n) {
        for (int k = 0; k < trace.taps(); ++k) frame[k] = gain[k] * trace.column(k)[n];
        good = sf_writef_double(file, frame.data(), 1) == 1;
    }
    const int reason = errno;
    if (sf_close(file) != 0 || !good) throw std::runtime_error(std::strerror(good ? errno : reason));
    return said;
}

void check_wav(const std::string& out, const std::string& format, const Scene& scene, double tap_rate) {
    constexpr std::size_t most_channels = 1024;  // of libsndfile
    constexpr double most_bytes = 4e9;           // a .wav counts its bytes in 32 bits
    if (tap_rate != std::round(tap_rate) || tap_rate > 2e9)
        throw UsageError(fmt::format("{}: a .wav needs a whole number of rows per second, not {}", out, tap_rate));
    if (scene.taps.empty()) throw UsageError(fmt::format("{}: a .wav has a channel per tap, and scene {} has no tap", out, scene.name));
    if (scene.taps.size() > most_channels)
        throw UsageError(fmt::format("{}: a .wav has a channel per tap, at most {}; scene {} has {} taps. A .csv or .h5 holds them", out,
                                     most_channels, scene.name, scene.taps.size()));
    const double bytes = scene.duration * tap_rate * static_cast<double>(scene.taps.size()) *
                         (format == "float32" ? 4
                          : format == "pcm24" ? 3
                          : format == "pcm16" ? 2
                                              : 8);
    if (bytes > most_bytes)
        throw UsageError(
            fmt::format("{}: a .wav holds at most {:.0e} bytes, this would be {:.1e}. A .csv or .h5 holds them", out, most_bytes, bytes));
}
}  // namespace

std::vector<std::string> trace_columns(const Trace& trace) {
    std::vector<std::string> columns{"time_s"};
    columns.insert(columns.end(), trace.names.begin(), trace.names.end());
    if (!trace.energy.empty()) columns.insert(columns.end(), std::begin(energy_names), std::end(energy_names));
    return columns;
}

void check(const TraceFile& file, const Scene& scene, double tap_rate) {
    const std::string extension = file.path.extension().string(), out = "--out " + file.path.string();
    if (extension != ".csv" && extension != ".wav" && extension != ".h5")
        throw UsageError(fmt::format("{}: found the extension \"{}\", expected .csv, .wav or .h5", out, extension));
    if (extension != ".wav" && !file.wav_format.empty()) throw UsageError("--wav-format goes with --out FILE.wav, not with " + extension);
    if (extension == ".wav") check_wav(out, file.wav_format, scene, tap_rate);
    for (const Tap& tap : scene.taps)
        if (extension == ".h5" && tap.name == ".")
            throw UsageError(out + ": a .h5 has a dataset per tap, and none can be named \".\". A .csv holds it");
    must_be_writable(file.path);
}

std::string write(const TraceFile& file, const Scene& scene, const Trace& trace) {
    FreshFile fresh(file.path);
    std::string said;
    const std::string extension = file.path.extension().string();
    try {
        if (extension == ".csv") write_csv(fresh.path(), trace);
        else if (extension == ".wav") said = write_wav(fresh.path(), file.wav_format, trace);
        else write_hdf5(fresh.path(), file.attributes, scene, trace);
    } catch (const std::runtime_error& why) {
        throw Unwritable(fmt::format("cannot write {}: {}", file.path.string(), why.what()));
    }
    fresh.keep();
    return said;
}

}  // namespace jvari::bench::store
