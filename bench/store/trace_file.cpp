#include "bench/store/trace_file.hpp"

#include <fmt/format.h>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "bench/store/audio_file.hpp"
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

void check_audio(const std::string& out, const std::string& extension, const std::string& format, const Scene& scene, double tap_rate) {
    constexpr double most_bytes = 4e9;  // a .wav counts its bytes in 32 bits
    if (tap_rate != std::round(tap_rate) || tap_rate < slowest_played || tap_rate > fastest_played)
        throw UsageError(fmt::format("{}: players take a whole number of rows per second from {} to {}, not {}: say --tap-rate", out,
                                     slowest_played, fastest_played, tap_rate));
    const double bytes = scene.duration * tap_rate * (format == "pcm16" ? 2 : 3);
    if (bytes > most_bytes)
        throw UsageError(fmt::format("{}: a {} holds at most {:.0e} bytes, this would be {:.1e}. A .csv or .h5 holds them", out, extension,
                                     most_bytes, bytes));
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
    const bool audio = is_audio(file.path);
    if (extension != ".csv" && !audio && extension != ".h5")
        throw UsageError(fmt::format("{}: found the extension \"{}\", expected .csv, .wav, .flac or .h5", out, extension));
    if (!audio && !file.wav_format.empty()) throw UsageError("--wav-format goes with --out FILE.wav or .flac, not with " + extension);
    if (audio) check_audio(out, extension, file.wav_format, scene, tap_rate);
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
        else if (is_audio(file.path)) {
            const Played p = played(trace.column(0), trace.tap_rate);
            write_audio(fresh.path(), extension, file.wav_format == "pcm16" ? 16 : 24, trace.tap_rate, p);
            said = level_text(p);
        } else write_hdf5(fresh.path(), file.attributes, scene, trace);
    } catch (const std::runtime_error& why) {
        throw Unwritable(fmt::format("cannot write {}: {}", file.path.string(), why.what()));
    }
    fresh.keep();
    return said;
}

}  // namespace jvari::bench::store
