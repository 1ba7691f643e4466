// How far the energy columns of a trace are from balance, row by row and summed. Independent of
// analysis/energy, which is tested as well.
#pragma once

#include <algorithm>
#include <cmath>

#include "schemes/trace.hpp"

namespace jvari {

struct Ledger {
    double worst_step = 0, accumulated = 0;  // relative to the largest stored energy
};
inline Ledger ledger(const Trace& t) {
    const auto H = t.energy_column(0), P = t.energy_column(1), Q = t.energy_column(2);
    const double largest = *std::max_element(H.begin(), H.end());
    Ledger l;
    double sum = 0;
    for (long n = 1; n < t.rows; ++n) {
        const double residual = H[n] - H[n - 1] - P[n] + Q[n];
        sum += residual;
        l.worst_step = std::max(l.worst_step, std::abs(residual) / largest);
        l.accumulated = std::max(l.accumulated, std::abs(sum) / largest);
    }
    return l;
}

}  // namespace jvari
