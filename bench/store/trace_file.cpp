#include "bench/store/trace_file.hpp"

#include <fmt/format.h>
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
}  // namespace

std::vector<std::string> trace_columns(const Trace& trace) {
    std::vector<std::string> columns{"time_s"};
    columns.insert(columns.end(), trace.names.begin(), trace.names.end());
    if (!trace.energy.empty()) columns.insert(columns.end(), std::begin(energy_names), std::end(energy_names));
    return columns;
}

void check(const TraceFile& file, const Scene& scene) {
    const std::string extension = file.path.extension().string(), out = "--out " + file.path.string();
    if (extension != ".csv" && extension != ".h5")
        throw UsageError(fmt::format("{}: found the extension \"{}\", expected .csv, .wav, .flac or .h5", out, extension));
    for (const Tap& tap : scene.taps)
        if (extension == ".h5" && tap.name == ".")
            throw UsageError(out + ": a .h5 has a dataset per tap, and none can be named \".\". A .csv holds it");
    must_be_writable(file.path);
}

void write(const TraceFile& file, const Scene& scene, const Trace& trace) {
    FreshFile fresh(file.path);
    try {
        if (file.path.extension() == ".csv") write_csv(fresh.path(), trace);
        else write_hdf5(fresh.path(), file.attributes, scene, trace);
    } catch (const std::runtime_error& why) {
        throw Unwritable(fmt::format("cannot write {}: {}", file.path.string(), why.what()));
    }
    fresh.keep();
}

}  // namespace jvari::bench::store
