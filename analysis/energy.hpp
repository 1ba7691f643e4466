// The energy ledger of a run: stored[n] - stored[n-1] = supplied[n] - dissipated[n] (schemes/scheme.hpp; van Walstijn et al. 2016, eqs
// 49-52).
//
// All columns [J], one row per tap interval; supplied and dissipated are sums over the interval that ends at the row.
// A balance that closes is necessary, never sufficient: a scheme can keep an energy of its own exactly and still be wrong.
#pragma once

#include <span>

#include "schemes/trace.hpp"

namespace jvari {

struct EnergyBalance {
    double largest_stored;       // [J]; what the residuals are relative to
    double smallest_stored;      // [J]; negative: the scheme's energy is no norm of its state
    double step;                 // max_n |stored[n] - stored[n-1] - supplied[n] + dissipated[n]| / largest_stored
    long step_row;               // the row where it is reached; 0 where there is but one
    double accumulated;          // max_n |stored[n] - stored[0] - sum_{1..n} (supplied - dissipated)| / largest_stored
    double drift;                // (stored[last] - stored[0]) / largest_stored, the ledger's entries not taken off: for lossless runs
    double smallest_dissipated;  // [J] of one row; negative: a loss that feeds energy in
};

// Residuals are 0 for one row, +inf where an entry is not finite or a residual stands against no stored energy at all.
// All NaN for no rows. Throws std::invalid_argument where the columns differ in length.
EnergyBalance energy_balance(std::span<const double> stored, std::span<const double> supplied, std::span<const double> dissipated);
EnergyBalance energy_balance(const Trace&);  // all NaN where the run was not probed

// What a run gained, for schemes whose balance need not close: all by size, and a loss that feeds energy in counts as none.
struct EnergyGain {
    double budget;   // stored at the start and all that was supplied [J]
    double largest;  // excess of the stored energy over the ledger, relative to the budget at that row
};
EnergyGain energy_gain(const Trace&);  // NaN where the run was not probed, or its columns are empty

}  // namespace jvari
