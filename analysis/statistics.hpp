// Median and quartiles of repeated measurements. Two medians whose interquartile ranges overlap are
// a tie.
#pragma once

#include <span>

namespace jvari {

struct Spread {
    int count = 0;  // finite values; others are left out
    // in the unit of the values, linear between order statistics; NaN if count is 0
    double median, lower, upper;
    double smallest, largest;
};
Spread spread_of(std::span<const double> values);

// True if the interquartile ranges overlap or touch, or if one is unknown.
bool tie(const Spread&, const Spread&);

}  // namespace jvari
