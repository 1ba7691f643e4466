// Median and quartiles of repeated measurements.
#pragma once

#include <span>

namespace jvari {

struct Spread {
    int count = 0;  // finite values; others are left out
    // in the unit of the values, linear between order statistics; NaN if count is 0
    double median, lower, upper;
};
Spread spread_of(std::span<const double> values);

}  // namespace jvari
