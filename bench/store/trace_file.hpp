// A trace on disk, by extension: .csv (17 significant digits), .h5 (one dataset per tap).
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::store {

struct TraceFile {
    std::filesystem::path path;
    std::vector<std::pair<std::string, std::string>> attributes;  // of the run as a whole (.h5)
};

// Throws UsageError for a path that cannot be written and a trace that the format cannot hold; before the run, so that no work is lost.
void check(const TraceFile&, const Scene&);

// Throws Unwritable.
void write(const TraceFile&, const Scene&, const Trace&);

std::vector<std::string> trace_columns(const Trace&);  // time_s,<taps>[,energy_stored_J,energy_supplied_J,energy_dissipated_J]

// ---- A trace as HDF5: one dataset per tap (attribute "unit"), the energy columns where probed, the run's facts as attributes of the file.
// No time stamps: the same trace is the same bytes.

inline constexpr const char* energy_names[] = {"energy_stored_J", "energy_supplied_J", "energy_dissipated_J"};

// Throws std::runtime_error.
void write_hdf5(const std::filesystem::path&, const std::vector<std::pair<std::string, std::string>>& attributes, const Scene&,
                const Trace&);

}  // namespace jvari::bench::store
