// Energy balance of a run: stored[n] - stored[n-1] = supplied[n] - dissipated[n]
// (schemes/scheme.hpp; van Walstijn et al. 2016, eqs 49-52).
//
// All columns are in joules, one row per tap interval; supplied and dissipated are sums over the
// interval that ends at the row. A scheme whose balance closes may still be wrong: it can conserve
// an energy that is not the string's.
#pragma once

#include <span>

#include "schemes/trace.hpp"

namespace jvari {

struct EnergyBalance {
    double largest_stored;   // [J]; the residuals are relative to it
    double smallest_stored;  // [J]; if negative, the scheme's energy is no norm on its state
    // max_n |stored[n] - stored[n-1] - supplied[n] + dissipated[n]| / largest_stored
    double step;
    long step_row;  // the row where the maximum is reached; 0 for a single row
    // max_n |stored[n] - stored[0] - sum_{1..n} (supplied - dissipated)| / largest_stored
    double accumulated;
    // (stored[last] - stored[0]) / largest_stored; for runs without losses
    double drift;
    double smallest_dissipated;  // [J] in one row; if negative, a loss feeds energy in
};

// Residuals are 0 for a single row, and +inf if an entry is not finite or no energy was ever
// stored. Everything is NaN without rows. Throws std::invalid_argument if the columns differ in
// length.
EnergyBalance energy_balance(std::span<const double> stored, std::span<const double> supplied,
                             std::span<const double> dissipated);
EnergyBalance energy_balance(const Trace&);  // all NaN if the run was not probed

// Energy gained in a run, for schemes whose balance need not close. A loss that feeds energy in
// counts for none.
struct EnergyGain {
    double budget;  // energy stored at the start plus all supplied energy [J]
    // largest excess of the stored energy over the balance, relative to the row's budget
    double largest;
};
EnergyGain energy_gain(const Trace&);  // NaN if the run was not probed or its columns are empty

}  // namespace jvari
