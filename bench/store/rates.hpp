#pragma once

#include <cmath>

namespace jvari::bench::store {

// rate = n x of, n = 1, 2, ...
inline bool whole_multiple(double rate, double of) {
    const double ratio = rate / of;
    return std::round(ratio) >= 1 && std::abs(ratio - std::round(ratio)) <= 1e-9 * ratio;
}

}  // namespace jvari::bench::store
