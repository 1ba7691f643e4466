// A trace on disk as .csv, with 17 significant digits:
// time_s,<taps>[,energy_stored_J,energy_supplied_J,energy_dissipated_J].
#pragma once

#include <filesystem>

#include "schemes/trace.hpp"

namespace jvari::bench::store {

inline constexpr const char* energy_names[] = {"energy_stored_J", "energy_supplied_J",
                                               "energy_dissipated_J"};

// Throws UsageError for a path that cannot be written; before the run, so that no work is lost.
void check_trace_file(const std::filesystem::path&);

// Throws Unwritable.
void write_trace(const std::filesystem::path&, const Trace&);

}  // namespace jvari::bench::store
