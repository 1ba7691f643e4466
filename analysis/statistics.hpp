// What repeats of a measurement say: the median is quoted with its spread, and two medians whose spreads overlap are a tie.
#pragma once

#include <span>

namespace jvari {

struct Spread {
    int count = 0;                // values that are finite; the rest are left out
    double median, lower, upper;  // median and quartiles (linear between order statistics), in the unit of the values; NaN where count is 0
    double smallest, largest;
};
Spread spread_of(std::span<const double> values);

// The interquartile ranges overlap (touching counts), or there is nothing to tell them apart by: the difference is not a finding.
bool tie(const Spread&, const Spread&);

}  // namespace jvari
