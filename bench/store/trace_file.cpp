#include "bench/store/trace_file.hpp"

#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "bench/store/console.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/trace_hdf5.hpp"

namespace jvari {

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
    if (!stream) throw UsageError("cannot write " + path.string());
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
    if (!file) throw UsageError("cannot write " + path.string() + ": " + sf_strerror(nullptr));
    sf_command(file, SFC_SET_CLIPPING, nullptr, SF_TRUE);
    std::vector<double> frame(trace.taps());
    bool good = true;
    for (long n = 0; n < trace.rows && good; ++n) {
        for (int k = 0; k < trace.taps(); ++k) frame[k] = gain[k] * trace.column(k)[n];
        good = sf_writef_double(file, frame.data(), 1) == 1;
    }
    if (sf_close(file) != 0 || !good) throw UsageError("cannot write " + path.string());
    return said;
}
}  // namespace

std::vector<std::string> trace_columns(const Trace& trace) {
    std::vector<std::string> columns{"time_s"};
    columns.insert(columns.end(), trace.names.begin(), trace.names.end());
    if (!trace.energy.empty()) columns.insert(columns.end(), std::begin(energy_names), std::end(energy_names));
    return columns;
}

void check(const TraceFile& file, double tap_rate) {
    const std::string extension = file.path.extension().string();
    if (extension != ".csv" && extension != ".wav" && extension != ".h5")
        throw UsageError(fmt::format("--out {}: found the extension \"{}\", expected .csv, .wav or .h5", file.path.string(), extension));
    if (extension != ".wav" && !file.wav_format.empty()) throw UsageError("--wav-format goes with --out FILE.wav, not with " + extension);
    if (extension == ".wav" && (tap_rate != std::round(tap_rate) || tap_rate > 2e9))
        throw UsageError(fmt::format("--out {}: a .wav needs a whole number of rows per second, not {}", file.path.string(), tap_rate));
    must_be_writable(file.path);
}

std::string write(const TraceFile& file, const Scene& scene, const Trace& trace) {
    FreshFile fresh(file.path);
    std::string said;
    const std::string extension = file.path.extension().string();
    if (extension == ".csv") write_csv(fresh.path(), trace);
    else if (extension == ".wav") said = write_wav(fresh.path(), file.wav_format, trace);
    else write_hdf5(fresh.path(), file.attributes, scene, trace);
    fresh.keep();
    return said;
}

}  // namespace jvari
