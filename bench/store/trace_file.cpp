#include "bench/store/trace_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>
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

namespace {

void must(herr_t status) {
    if (status < 0) throw std::runtime_error(errno == ENOSPC || errno == EFBIG || errno == EDQUOT ? std::strerror(errno) : "HDF5 refuses");
}

struct Handle {  // closes what was opened; every id is checked once, here
    Handle(hid_t i, herr_t (*c)(hid_t)) : id(i), closes(c) { must(id < 0 ? -1 : 0); }
    ~Handle() {
        if (id >= 0) closes(id);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    void close() { must(closes(std::exchange(id, -1))); }  // where it matters what that says
    hid_t id;
    herr_t (*closes)(hid_t);
};

void attribute(hid_t at, const std::string& name, const std::string& text) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    must(H5Tset_size(type.id, text.empty() ? 1 : text.size()));
    must(H5Tset_cset(type.id, H5T_CSET_UTF8));
    Handle a(H5Acreate2(at, name.c_str(), type.id, space.id, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    must(H5Awrite(a.id, type.id, text.c_str()));
}

void attribute(hid_t at, const std::string& name, double value) {
    Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    Handle a(H5Acreate2(at, name.c_str(), H5T_IEEE_F64LE, space.id, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    must(H5Awrite(a.id, H5T_NATIVE_DOUBLE, &value));
}

void dataset(hid_t file, const std::string& name, std::span<const double> values, const std::string& unit) {
    const hsize_t size = values.size();
    Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose), links(H5Pcreate(H5P_LINK_CREATE), H5Pclose),
        how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    must(H5Pset_create_intermediate_group(links.id, 1));  // a tap may be named "left/nut"
    must(H5Pset_obj_track_times(how.id, false));
    Handle set(H5Dcreate2(file, name.c_str(), H5T_IEEE_F64LE, space.id, links.id, how.id, H5P_DEFAULT), H5Dclose);
    must(H5Dwrite(set.id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    attribute(set.id, "unit", unit);
}
}  // namespace

void write_hdf5(const std::filesystem::path& path, const std::vector<std::pair<std::string, std::string>>& attributes, const Scene& scene,
                const Trace& trace) {
    H5dont_atexit();                              // a file that could not be closed would be flushed once more there, and crash
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // messages are ours
    Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    attribute(file.id, "tap_rate", trace.tap_rate);
    for (const auto& [name, text] : attributes) {
        const double number = number_of(text);
        if (number == number) attribute(file.id, name, number);
        else attribute(file.id, name, text);
    }
    for (int k = 0; k < trace.taps(); ++k) dataset(file.id, trace.names[k], trace.column(k), unit_of(scene.taps[k].quantity));
    for (int k = 0; k < 3 && !trace.energy.empty(); ++k) dataset(file.id, energy_names[k], trace.energy_column(k), "J");
    must(H5Fflush(file.id, H5F_SCOPE_GLOBAL));
    file.close();
}

}  // namespace jvari::bench::store
