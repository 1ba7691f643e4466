// A trace as HDF5: one dataset per tap (attribute "unit"), the energy columns where probed, the run's facts as attributes of the file. No
// time stamps: the same trace is the same bytes.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::store {

inline constexpr const char* energy_names[] = {"energy_stored_J", "energy_supplied_J", "energy_dissipated_J"};

// Throws std::runtime_error.
void write_hdf5(const std::filesystem::path&, const std::vector<std::pair<std::string, std::string>>& attributes, const Scene&,
                const Trace&);

}  // namespace jvari::bench::store
