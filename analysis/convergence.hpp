// The observed order of convergence, with a confidence interval.
//
// error = C rate^-order is a straight line in logarithms, fitted by least squares (GSL). The
// interval follows from the scatter of the residuals and Student's t, with two degrees of freedom
// fewer than there are points.
// The fit does not know which rates are in the asymptotic range.
#pragma once

#include <span>

namespace jvari {

struct Order {
    double order;  // NaN if fewer than two points can be used
    // the 95 % interval is order +- half_width; +inf with two points, which have no scatter
    double half_width;
    int points;  // points used; errors that are not finite or not positive are left out
};

// rate and error have one entry per run, in any order. Throws std::invalid_argument if the lengths
// differ.
Order observed_order(std::span<const double> rate, std::span<const double> error);

}  // namespace jvari
