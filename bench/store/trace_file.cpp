#include "bench/store/trace_file.hpp"

#include <fmt/format.h>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::store {

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
