// Order of convergence with its confidence.
//
// error = C rate^-order is a straight line in logarithms (line.hpp). Leaves out: which rates are in the asymptotic range; `scatter` shows
// where they are not (near contact the order is about 1, and late windows saturate).
#pragma once

#include <span>
#include <vector>

namespace jvari {

struct Order {
    double order;       // NaN where fewer than two points serve
    double half_width;  // of the confidence interval: order +- half_width; +inf with two points, which leave no scatter to judge by
    double constant;    // C: the error at rate 1 (in the unit of the rate)
    double scatter;     // weighted root mean square of the residuals, in factors of e
    int points;         // used: an error that is not finite or not positive (failed, exact) is left out
};

// rate and error: one entry per run, any order; weight: relative weight of each, empty for equal ones (an entry <= 0 is left out).
// Throws std::invalid_argument where the lengths differ.
Order observed_order(std::span<const double> rate, std::span<const double> error, std::span<const double> weight = {},
                     double confidence = 0.95);

}  // namespace jvari
