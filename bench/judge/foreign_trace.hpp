// Traces that other programs wrote, on the rows of a scene.
//
//   .csv  a line of names, then a line a row: time_s, a column for each tap by its name, and
//         energy_stored_J, energy_supplied_J,
//         energy_dissipated_J where there are all three. Further columns are not looked at.
//   .wav  one tap in its own unit; its sample rate is the tap rate.
#pragma once

#include <filesystem>
#include <memory>

#include "scenes/scene.hpp"
#include "schemes/scheme.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::judge {

// `rows`: as many as a whole run has; fewer are a trace that stops early. Throws UsageError: other
// instants, more rows, a tap that is missing, a line that is cut off, what is no number.
Trace read_trace(const std::filesystem::path&, const Scene&, double tap_rate, long rows);

// Throws UsageError where an array of a tap has more rows than the scene, or other arrays have
// other lengths.
void check_rows(const Trace&, const std::string& what, long rows);

// The same, and where it has fewer rows, or holds what is no number: such a trace cannot be judged
// whole.
void must_be_whole(const Trace&, const std::string& what, long rows);

// ---- A trace that another program made, as a scheme: whatever is asked of schemes is asked of it.

// Gives its rows; beyond them, NaN, so that a run ends there as diverged.
std::unique_ptr<Scheme> played(std::shared_ptr<const Trace>);

constexpr Features every_feature{(1u << feature_count) - 1};

}  // namespace jvari::bench::judge
