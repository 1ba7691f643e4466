// The observed order of convergence, with a confidence interval.
//
// error = C rate^-order is a straight line in logarithms (line.hpp). The fit does not know which rates are in the asymptotic range. A large
// `scatter` shows that some are not.
#pragma once

#include <span>
#include <vector>

namespace jvari {

struct Order {
    double order;       // NaN if fewer than two points can be used
    double half_width;  // the confidence interval is order +- half_width; +inf with two points, which have no scatter
    double constant;    // C: the error at rate 1 (in the unit of the rate)
    double scatter;     // weighted root mean square of the residuals, in factors of e
    int points;         // points used; errors that are not finite or not positive are left out
};

// rate and error have one entry per run, in any order. weight is the relative weight of each (<= 0: left out); empty means equal weights.
// Throws std::invalid_argument if the lengths differ.
Order observed_order(std::span<const double> rate, std::span<const double> error, std::span<const double> weight = {},
                     double confidence = 0.95);

}  // namespace jvari
