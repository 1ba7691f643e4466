// Source: energy.hpp. Sums are carried in long double: a ledger that closes to 1e-11 must not gain
// a rounding of 1e-12 from a second of rows.
#include "analysis/energy.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace jvari {

EnergyBalance energy_balance(std::span<const double> stored, std::span<const double> supplied,
                             std::span<const double> dissipated) {
    if (stored.size() != supplied.size() || stored.size() != dissipated.size())
        throw std::invalid_argument("the energy columns differ in length");
    if (stored.empty()) return {nan, nan, nan, 0, nan, nan, nan};

    EnergyBalance balance{
        std::abs(stored[0]), stored[0], 0, 0, 0, 0, dissipated.size() > 1 ? inf : 0};
    long double ledger = stored[0], step = 0, accumulated = 0;
    for (std::size_t n = 1; n < stored.size(); ++n) {
        const long double entry = static_cast<long double>(supplied[n]) - dissipated[n];
        const long double residual =
            std::abs(static_cast<long double>(stored[n]) - stored[n - 1] - entry);
        ledger += entry;
        if (!std::isfinite(residual)) {  // also if stored[n] or an entry is not finite
            balance.step = balance.accumulated = inf;
            balance.drift = nan;
            balance.step_row = static_cast<long>(n);
            return balance;
        }
        if (residual > step) {
            step = residual;
            balance.step_row = static_cast<long>(n);
        }
        accumulated = std::max(accumulated, std::abs(stored[n] - ledger));
        balance.largest_stored = std::max(balance.largest_stored, std::abs(stored[n]));
        balance.smallest_stored = std::min(balance.smallest_stored, stored[n]);
        balance.smallest_dissipated = std::min(balance.smallest_dissipated, dissipated[n]);
    }
    if (!std::isfinite(stored[0]))
        return {balance.largest_stored, balance.smallest_stored, inf, 0, inf, nan, nan};
    const auto relative = [&](long double x) {
        return x == 0                       ? 0.0
               : balance.largest_stored > 0 ? static_cast<double>(x / balance.largest_stored)
                                            : inf;
    };
    balance.step = relative(step);
    balance.accumulated = relative(accumulated);
    balance.drift = relative(static_cast<long double>(stored.back()) - stored[0]);
    return balance;
}

EnergyBalance energy_balance(const Trace& trace) {
    if (trace.energy.empty()) return energy_balance({}, {}, {});
    return energy_balance(trace.energy_column(0), trace.energy_column(1), trace.energy_column(2));
}

EnergyGain energy_gain(const Trace& t) {
    if (t.energy.empty() || t.rows < 1) return {nan, nan};
    const auto stored = t.energy_column(0), supplied = t.energy_column(1),
               dissipated = t.energy_column(2);
    double budget = std::abs(stored[0]), ledger = stored[0], gain = 0, last = 0;
    for (long n = 1; n < t.rows; ++n) {
        budget += std::abs(supplied[n]);
        ledger += supplied[n] - std::max(dissipated[n], 0.0);
        last = std::max(last, std::abs(stored[n]));
        if (budget > 0) gain = std::max(gain, (stored[n] - ledger) / budget);
    }
    if (!(budget > 0) && last == 0) return {nan, nan};
    return {budget, gain};
}

}  // namespace jvari
