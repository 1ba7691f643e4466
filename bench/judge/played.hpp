// A trace that another program made, as a scheme: whatever is asked of schemes is asked of it.
#pragma once

#include <memory>

#include "schemes/scheme.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::judge {

// Gives its rows; beyond them, NaN, so that a run ends there as diverged.
std::unique_ptr<Scheme> played(std::shared_ptr<const Trace>);

constexpr Features every_feature{(1u << feature_count) - 1};

}  // namespace jvari::bench::judge
